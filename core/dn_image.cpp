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
#include "core/tiff_pages.h"

namespace stipple {
namespace {

/// The bytes of a picture that is fit to be decoded.
std::vector<std::uint8_t> checked_bytes(const std::filesystem::path& file) {
    const std::string place = file.string();
    const ImageFormat format = image_format(file);
    if (format == ImageFormat::kPng) return critical_png_chunks(read_file(file), place).file;
    if (format != ImageFormat::kTiff)
        throw InputError(place, "is no image of digital numbers; give PNG or TIFF");
    auto bytes = read_file(file);
    check_single_tiff_page(bytes, place);
    return bytes;
}

cv::Mat decoded(const std::vector<std::uint8_t>& bytes, const std::string& place) {
    cv::Mat image;
    try {
        if (!bytes.empty()) image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
        image.release();
    }
    if (image.empty())
        throw InputError(place, "cannot be decoded; it is damaged or ends too early");
    if (image.type() != CV_8UC1 && image.type() != CV_16UC1)
        throw InputError(place, "is not grey with 8 or 16 bits");
    return image.isContinuous() ? image : image.clone();
}

}  // namespace

DnImage read_dn_image(const std::filesystem::path& file) {
    silence_opencv();
    const cv::Mat image = decoded(checked_bytes(file), file.string());
    DnImage result{{.rows = image.rows, .cols = image.cols, .planes = 1},
                   std::vector<std::uint16_t>(image.total())};
    if (image.depth() == CV_16U)
        std::copy_n(image.ptr<std::uint16_t>(), image.total(), result.dn.begin());
    else
        std::copy_n(image.ptr<std::uint8_t>(), image.total(), result.dn.begin());
    return result;
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
