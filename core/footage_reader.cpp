#include "core/footage_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/footage_files.h"
#include "core/image_file.h"
#include "core/light.h"
#include "core/npy_reader.h"
#include "core/video_reader.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Reads pictures one after the other.
class ImageSequence {
  public:
    /// Precondition: at least one file.
    explicit ImageSequence(std::vector<fs::path> files) : files_(std::move(files)) {
        read_image(files_.front(), picture_);
        shape_ = picture_.shape;
    }

    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] int slots() const { return static_cast<int>(files_.size()); }
    [[nodiscard]] std::string place() const { return files_[next_ - 1].string(); }

    bool read(std::span<float> frame) {
        if (next_ == files_.size()) return false;
        ++next_;
        if (next_ > 1) read_image(files_[next_ - 1], picture_);
        if (picture_.shape != shape_)
            throw InputError(place(), fmt::format("is {} x {} x {} (rows x columns x planes), but "
                                                  "the first frame is {} x {} x {}",
                                                  picture_.shape.rows, picture_.shape.cols,
                                                  picture_.shape.planes, shape_.rows, shape_.cols,
                                                  shape_.planes));
        std::copy(picture_.values.begin(), picture_.values.end(), frame.begin());
        return true;
    }

  private:
    std::vector<fs::path> files_;
    std::size_t next_ = 0;
    Picture picture_;
    FrameShape shape_;
};

using Source = std::variant<ImageSequence, NpyReader, VideoReader>;

/// Why a file of this extension is no footage.
const char* not_footage(const std::string& extension) {
    if (extension == ".stipple")
        return "is a sample stream, not footage; \"stipple decode\" makes video of it";
    if (extension == ".strec")
        return "is no recording of a camera: it is empty, or does not begin as one";
    return "is no footage by its extension; give a folder or pattern of PNG, TIFF or EXR "
           "pictures, a video file, or .npy";
}

Source open_source(const fs::path& source) {
    const std::string name = source.string();
    std::error_code error;
    const auto status = fs::status(source, error);
    if (fs::is_directory(status)) return ImageSequence(images_in_folder(source));
    if (!fs::exists(status)) {
        if (source.filename().string().find('%') != std::string::npos)
            return ImageSequence(images_of_pattern(source));
        throw InputError(name, error && status.type() == fs::file_type::none
                                   ? "cannot be read: " + error.message()
                                   : "there is no such file or folder");
    }
    if (lower_extension(source) == ".npy") return NpyReader(source);
    if (image_format(source) != ImageFormat::kNone) return ImageSequence({source});
    if (is_video_name(source)) return VideoReader(source);
    throw InputError(name, not_footage(lower_extension(source)));
}

}  // namespace

struct FootageReader::Impl {
    Source source;
    FootageOptions options;
    FrameShape source_shape;
    std::vector<float> colour;  ///< the frame before its reduction to luminance

    [[nodiscard]] bool reduces() const { return options.luminance && source_shape.planes == 3; }
};

FootageReader::FootageReader(const fs::path& source, FootageOptions options)
    : impl_(new Impl{open_source(source), options, {}, {}}) {
    impl_->source_shape = std::visit([](const auto& s) { return s.shape(); }, impl_->source);
    if (impl_->reduces()) impl_->colour.resize(impl_->source_shape.sites());
}

FootageReader::~FootageReader() = default;
FootageReader::FootageReader(FootageReader&&) noexcept = default;
FootageReader& FootageReader::operator=(FootageReader&&) noexcept = default;

FrameShape FootageReader::shape() const {
    FrameShape shape = impl_->source_shape;
    if (impl_->reduces()) shape.planes = 1;
    return shape;
}

std::optional<int> FootageReader::slots() const {
    if (const auto* images = std::get_if<ImageSequence>(&impl_->source)) return images->slots();
    if (const auto* npy = std::get_if<NpyReader>(&impl_->source)) return npy->slots();
    return std::nullopt;
}

std::optional<double> FootageReader::film_hz() const {
    const auto* video = std::get_if<VideoReader>(&impl_->source);
    return video == nullptr ? std::nullopt : video->film_hz();
}

bool FootageReader::read(std::span<float> frame) {
    assert(frame.size() == shape().sites());
    const auto light = impl_->reduces() ? std::span<float>(impl_->colour) : frame;
    const auto read = [&](auto& source) {
        if (!source.read(light)) return false;
        linearise(light, impl_->options.transfer);
        check_light(light, impl_->source_shape, source.place());
        return true;
    };
    if (!std::visit(read, impl_->source)) return false;
    if (impl_->reduces()) reduce_to_luminance(light, frame);
    if (impl_->options.max_value) {
        const auto most = static_cast<float>(*impl_->options.max_value);
        for (float& value : frame) value = std::min(value, most);
    }
    return true;
}

}  // namespace stipple
