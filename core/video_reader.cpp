#include "core/video_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/videoio.hpp>
#include <string_view>

#include "core/error.h"
#include "core/footage_files.h"
#include "core/interleaved.h"
#include "core/light.h"
#include "core/opencv_quiet.h"

namespace stipple {
namespace {

constexpr std::array<std::string_view, 16> kExtensions = {
    ".mp4", ".mkv", ".avi", ".mov", ".webm", ".m4v", ".mpg", ".mpeg",
    ".ts",  ".mts", ".wmv", ".flv", ".y4m",  ".ogv", ".mxf", ".3gp"};

/// Containers announce a frame count that may be off by some frames (it is often duration x rate).
constexpr double kLeastFractionOfAnnounced = 0.9;

/// What a container without a rate says is the tick of its time stamps: 90 kHz and the like.
constexpr double kMostHz = 80'000;

}  // namespace

struct VideoReader::Impl {
    std::string name;
    cv::VideoCapture capture;
    cv::Mat image;  ///< the frame that read() returns next; empty at the end
    FrameShape shape;
    int next_slot = 0;
    double announced_frames = 0;
    std::optional<double> film_hz;

    /// Decodes into `image`.
    void advance() {
        try {
            if (!capture.read(image)) image.release();
        } catch (const cv::Exception&) {
            image.release();
        }
    }
};

bool is_video_name(const std::filesystem::path& file) {
    return std::find(kExtensions.begin(), kExtensions.end(), lower_extension(file)) !=
           kExtensions.end();
}

VideoReader::VideoReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
    silence_opencv();
    impl_->name = file.string();
    try {
        impl_->capture.open(impl_->name, cv::CAP_FFMPEG);
    } catch (const cv::Exception&) {
        impl_->capture.release();
    }
    if (impl_->capture.isOpened()) impl_->advance();
    if (impl_->image.empty())
        throw InputError(impl_->name,
                         "cannot be decoded as video; it is damaged, ends too early "
                         "or holds no frames");
    impl_->announced_frames = impl_->capture.get(cv::CAP_PROP_FRAME_COUNT);
    const double hz = impl_->capture.get(cv::CAP_PROP_FPS);
    if (hz > 0 && hz < kMostHz) impl_->film_hz = hz;
    impl_->shape = checked_shape(static_cast<std::uint64_t>(impl_->image.rows),
                                 static_cast<std::uint64_t>(impl_->image.cols), 3, impl_->name);
}

VideoReader::~VideoReader() = default;
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;

FrameShape VideoReader::shape() const {
    return impl_->shape;
}

std::optional<double> VideoReader::film_hz() const {
    return impl_->film_hz;
}

std::string VideoReader::place() const {
    return fmt::format("{}: frame {}", impl_->name, impl_->next_slot - 1);
}

bool VideoReader::read(std::span<float> frame) {
    const cv::Mat& image = impl_->image;
    if (image.empty()) {
        if (impl_->next_slot < kLeastFractionOfAnnounced * impl_->announced_frames)
            throw InputError(impl_->name,
                             fmt::format("ends after {} of {:.0f} frames; it is truncated or "
                                         "damaged",
                                         impl_->next_slot, impl_->announced_frames));
        return false;
    }
    ++impl_->next_slot;
    if (image.rows != impl_->shape.rows || image.cols != impl_->shape.cols ||
        image.type() != CV_8UC3)
        throw InputError(place(), "differs in size or format from the first frame");
    const std::span bytes(image.data, image.total() * image.elemSize());
    split_planes<std::uint8_t>(std::as_bytes(bytes), {3, true}, 3, frame, UnitScale());
    impl_->advance();
    return true;
}

}  // namespace stipple
