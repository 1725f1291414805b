#include "core/dn_image.h"

#include <algorithm>
#include <cassert>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "core/error.h"
#include "core/footage_files.h"
#include "core/input_file.h"
#include "core/opencv_quiet.h"
#include "core/output_file.h"
#include "core/png_chunks.h"
#include "core/tiff_file.h"

namespace stipple {
namespace {

[[noreturn]] void fail_kind(const std::string& place) {
    throw InputError(place, "is not grey with 8 or 16 bits");
}

/// Row after row, each number as it is.
template <typename Sample>
DnImage dn_image(FrameShape shape, const void* samples) {
    const auto* const first = static_cast<const Sample*>(samples);
    return {shape, {first, first + shape.pixels()}};
}

DnImage read_dn_png(const std::string& place) {
    cv::Mat image;
    try {
        image =
            cv::imdecode(critical_png_chunks(read_file(place), place).file, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
        image.release();
    }
    if (image.empty())
        throw InputError(place, "cannot be decoded; it is damaged or ends too early");
    if (!image.isContinuous()) image = image.clone();
    const FrameShape shape{.rows = image.rows, .cols = image.cols, .planes = 1};
    if (image.type() == CV_16UC1) return dn_image<std::uint16_t>(shape, image.data);
    if (image.type() != CV_8UC1) fail_kind(place);
    return dn_image<std::uint8_t>(shape, image.data);
}

DnImage read_dn_tiff(const std::filesystem::path& file) {
    const TiffPixels pixels = read_single_tiff(file);
    if (pixels.channels != 1 || pixels.sample == TiffPixels::Sample::kF32) fail_kind(file.string());
    if (pixels.sample == TiffPixels::Sample::kU16)
        return dn_image<std::uint16_t>(pixels.shape, pixels.bytes.data());
    return dn_image<std::uint8_t>(pixels.shape, pixels.bytes.data());
}

}  // namespace

DnImage read_dn_image(const std::filesystem::path& file) {
    silence_opencv();
    switch (image_format(file)) {
        case ImageFormat::kPng:
            return read_dn_png(file.string());
        case ImageFormat::kTiff:
            return read_dn_tiff(file);
        default:
            throw InputError(file.string(), "is no image of digital numbers; give PNG or TIFF");
    }
}

void write_dn_png(const std::filesystem::path& file, FrameShape shape,
                  std::span<const std::uint16_t> dn) {
    assert(dn.size() == shape.pixels());
    silence_opencv();
    cv::Mat image(shape.rows, shape.cols, CV_16UC1);
    std::ranges::copy(dn, image.ptr<std::uint16_t>());
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    OutputFile output(file, file.string());
    output.write(std::as_bytes(std::span(bytes)));
    output.close();
}

}  // namespace stipple
