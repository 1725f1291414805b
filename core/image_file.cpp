#include "core/image_file.h"

#include <fmt/format.h>

#include <cassert>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/exr_file.h"
#include "core/footage_files.h"
#include "core/input_file.h"
#include "core/interleaved.h"
#include "core/light.h"
#include "core/opencv_quiet.h"
#include "core/output_file.h"
#include "core/png_chunks.h"
#include "core/tiff_pages.h"
#include "core/tone_map.h"

namespace stipple {
namespace {

/// `flags` as in cv::imdecode. \throws InputError if the picture cannot be decoded.
cv::Mat decode(const std::vector<std::uint8_t>& bytes, int flags, const std::string& place) {
    silence_opencv();
    cv::Mat image;
    try {
        if (!bytes.empty()) image = cv::imdecode(bytes, flags);
    } catch (const cv::Exception&) {
        image.release();
    }
    if (image.empty())
        throw InputError(place, "cannot be decoded; it is damaged or ends too early");
    return image;
}

void copy_planes(const cv::Mat& image, const std::string& place, Picture& picture) {
    const int channels = image.channels();
    const int planes = channels == 4 ? 3 : channels;
    picture.resize(checked_shape(static_cast<std::uint64_t>(image.rows),
                                 static_cast<std::uint64_t>(image.cols),
                                 static_cast<std::uint64_t>(planes), place));
    const cv::Mat packed = image.isContinuous() ? image : image.clone();
    const std::span bytes(packed.data, packed.total() * packed.elemSize());
    const auto split = [&]<typename Sample>(Sample, auto to_float) {
        split_planes<Sample>(std::as_bytes(bytes), {channels, true}, planes, picture.values,
                             to_float);
    };
    switch (image.depth()) {
        case CV_8U:
            return split(std::uint8_t{}, UnitScale());
        case CV_16U:
            return split(std::uint16_t{}, UnitScale());
        case CV_32F:
            return split(float{}, [](float value) { return value; });
        default:
            throw InputError(place, "give 8- or 16-bit integers or 32-bit floats");
    }
}

void read_png(const std::string& place, Picture& picture) {
    const PngChunks png = critical_png_chunks(read_file(place), place);
    const int layout = png.grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR;
    copy_planes(decode(png.file, layout | cv::IMREAD_ANYDEPTH, place), place, picture);
}

void read_tiff(const std::string& place, Picture& picture) {
    const auto bytes = read_file(place);
    check_single_tiff_page(bytes, place);
    copy_planes(decode(bytes, cv::IMREAD_UNCHANGED, place), place, picture);
}

}  // namespace

void read_image(const std::filesystem::path& file, Picture& picture) {
    switch (image_format(file)) {
        case ImageFormat::kPng:
            return read_png(file.string(), picture);
        case ImageFormat::kTiff:
            return read_tiff(file.string(), picture);
        case ImageFormat::kExr:
            return read_exr(file, picture);
        case ImageFormat::kNone:
            break;
    }
    throw InputError(file.string(), "is not a picture that can be read; give PNG, TIFF or EXR");
}

void write_png(const std::filesystem::path& file, FrameShape shape, std::span<const float> frame) {
    assert(frame.size() == shape.sites());
    silence_opencv();
    cv::Mat image(shape.rows, shape.cols, shape.planes == 1 ? CV_8UC1 : CV_8UC3);
    tone_map_frame(frame, shape, {image.data, shape.sites()});
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", image, bytes);
    OutputFile output(file, file.string());
    output.write(std::as_bytes(std::span(bytes)));
    output.close();
}

}  // namespace stipple
