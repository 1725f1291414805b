#include "io/footage_formats.h"

#include <fmt/format.h>

#include <cctype>
#include <system_error>

#include "core/error.h"
#include "io/camera_file.h"
#include "io/image_file.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// A format of files with frames.
struct FrameFormat {
    std::string_view name;
    bool (*is_name)(const fs::path& file);  ///< by the extension
    FrameSource (*open)(const fs::path& file);
};

bool is_tiff_name(const fs::path& file) {
    const ImageReader* const reader = image_reader(file);
    return reader != nullptr && reader->name == "TIFF";
}

constexpr FrameFormat kFrameFormats[] = {
    {"TIFF", is_tiff_name,  // each page is a frame
     [](const fs::path& file) -> FrameSource { return ImageSequence({}, TiffFile(file)); }},
    {".npy", [](const fs::path& file) { return lower_extension(file) == ".npy"; },
     [](const fs::path& file) -> FrameSource { return NpyReader(file); }},
    {".cine", [](const fs::path& file) { return lower_extension(file) == ".cine"; },
     [](const fs::path& file) -> FrameSource { return RawVideoReader(open_cine(file)); }},
    {"Photron", is_photron_name,
     [](const fs::path& file) -> FrameSource { return RawVideoReader(open_photron(file)); }},
    {"FITS", is_fits_name, [](const fs::path& file) -> FrameSource { return FitsReader(file); }},
    {"video", is_video_name, [](const fs::path& file) -> FrameSource { return VideoReader(file); }},
};

/// Why a file cannot be footage, by its extension.
Message not_footage(const fs::path& source) {
    const std::string extension = lower_extension(source);
    if (extension == ".stipple")
        return "is a sample stream, not footage; \"stipple decode\" makes video of it";
    if (extension == ".strec")
        return "is not a recording of a camera: it is empty, or does not begin as one";
    if (const std::string remedy = conversion_of(source); !remedy.empty())
        return "is not a recognised footage format" + remedy;
    return "is not a recognised footage format; give a folder or pattern of " +
           image_format_names() +
           " images, a video or camera file, or .npy; a file without a header needs " +
           Parameter{"raw"};
}

}  // namespace

ImageSequence::ImageSequence(ImageFiles images, std::optional<TiffFile> tiff)
    : images_(std::move(images)), tiff_(std::move(tiff)) {
    load(0);
    traits_ = image_.traits;
    shape_ = image_.shape;
}

std::string ImageSequence::kind() const {
    if (tiff_) return "TIFF file";
    std::string extension = lower_extension(images_.files.front()).substr(1);
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return extension + (images_.files.size() == 1 ? " image" : " images");
}

bool ImageSequence::read(std::span<float> frame) {
    if (next_ == slots()) return false;
    ++next_;
    if (next_ > 1) load(next_ - 1);
    if (image_.shape != shape_)
        throw InputError(where(),
                         fmt::format("is {} x {} x {} (width x height x planes), but "
                                     "the first frame is {} x {} x {}",
                                     image_.shape.cols, image_.shape.rows, image_.shape.planes,
                                     shape_.cols, shape_.rows, shape_.planes));
    if (image_.traits.filter != traits_.filter)
        throw InputError(where(), "has another colour filter array than the first frame");
    if (image_.traits.gamma_coded != traits_.gamma_coded || image_.traits.curve != traits_.curve)
        throw InputError(where(), "declares another transfer function than the first frame");
    if (const double us = image_.traits.exposure_us.value_or(0); us > 0) {
        min_exposure_us_ = std::min(min_exposure_us_, us);
        max_exposure_us_ = std::max(max_exposure_us_, us);
    }
    std::copy(image_.values.begin(), image_.values.end(), frame.begin());
    return true;
}

std::string ImageSequence::exposure_warning() const {
    constexpr double kSameExposure = 0.01;
    if (max_exposure_us_ * (1 - kSameExposure) <= min_exposure_us_) return {};
    return fmt::format(
        "its frames were exposed for {:.4g} to {:.4g} us, for which their light is not "
        "corrected",
        min_exposure_us_, max_exposure_us_);
}

void ImageSequence::load(int slot) {
    if (!tiff_) return read_image(images_.files[static_cast<std::size_t>(slot)], image_);
    tiff_->read(slot, page_);
    to_image(page_, image_);
}

FrameSource open_source(const fs::path& source, const FootageOptions& options) {
    if (options.raw) return RawVideoReader(open_raw_file(source, *options.raw));
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
    for (const FrameFormat& format : kFrameFormats)
        if (format.is_name(source)) return format.open(source);
    if (image_reader(source) != nullptr) return ImageSequence({{source}, {}});
    throw InputError(name, not_footage(source));
}

bool is_footage_name(const fs::path& file) {
    return image_reader(file) != nullptr ||
           std::ranges::any_of(kFrameFormats,
                               [&](const FrameFormat& format) { return format.is_name(file); });
}

std::vector<std::string_view> footage_format_names() {
    std::vector<std::string_view> names;
    for (const ImageReader& reader : image_readers()) names.push_back(reader.name);
    for (const FrameFormat& format : kFrameFormats)
        if (std::ranges::find(names, format.name) == names.end()) names.push_back(format.name);
    return names;
}

}  // namespace stipple
