#include "io/video_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.h"
#include "io/footage_files.h"
#include "io/video_decoder.h"
#include "io/video_planes.h"

namespace stipple {
namespace {

constexpr std::array<std::string_view, 17> kExtensions = {
    ".mp4", ".mkv", ".avi", ".mov", ".webm", ".m4v", ".mpg", ".mpeg", ".ts",
    ".mts", ".wmv", ".flv", ".y4m", ".ogv",  ".mxf", ".3gp", ".gif"};

}  // namespace

struct VideoReader::Impl {
    std::string name;
    VideoDecoder decoder;
    const AVFrame* frame;  ///< that read() returns next; null at the end
    VideoPlanes planes;
    int next_slot = 0;

    explicit Impl(const std::filesystem::path& file)
        : name(file.string()),
          decoder(file),
          frame(decoder.next()),
          planes(*frame, decoder.quarter_turns(), name) {}
};

bool is_video_name(const std::filesystem::path& file) {
    return std::find(kExtensions.begin(), kExtensions.end(), lower_extension(file)) !=
           kExtensions.end();
}

VideoReader::VideoReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}

VideoReader::~VideoReader() = default;
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;

FrameShape VideoReader::shape() const {
    return impl_->planes.shape();
}

const SourceInfo& VideoReader::traits() const {
    return impl_->planes.traits();
}

std::vector<Message> VideoReader::warnings() const {
    return impl_->decoder.warnings();
}

std::optional<double> VideoReader::frames_hz() const {
    return impl_->decoder.frames_hz();
}

std::optional<std::int64_t> VideoReader::announced_frames() const {
    return impl_->decoder.announced_frames();
}

double VideoReader::frame_time() const {
    return impl_->decoder.frame_time();
}

std::string VideoReader::unequal_times() const {
    return impl_->decoder.unequal_times();
}

std::string VideoReader::where() const {
    return fmt::format("{}: frame {}", impl_->name, impl_->next_slot - 1);
}

bool VideoReader::read(std::span<float> frame) {
    if (impl_->next_slot > 0 && impl_->frame != nullptr) impl_->frame = impl_->decoder.next();
    if (impl_->frame == nullptr) return false;
    ++impl_->next_slot;
    if (!impl_->planes.convert(*impl_->frame, frame))
        throw InputError(where(), "differs in size or format from the first frame");
    return true;
}

}  // namespace stipple
