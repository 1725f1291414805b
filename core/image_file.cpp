#include "core/image_file.h"

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
#include "core/tone_map.h"

namespace stipple {
namespace {

/// \throws InputError if the picture cannot be decoded.
cv::Mat decode(const PngChunks& png, const std::string& place) {
    silence_opencv();
    const int layout = png.grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR;
    cv::Mat image;
    try {
        image = cv::imdecode(png.file, layout | cv::IMREAD_ANYDEPTH);
    } catch (const cv::Exception&) {
        image.release();
    }
    if (image.empty())
        throw InputError(place, "cannot be decoded; it is damaged or ends too early");
    return image.isContinuous() ? image : image.clone();
}

void read_png(const std::string& place, Picture& picture) {
    const PngChunks png = critical_png_chunks(read_file(place), place);
    const cv::Mat image = decode(png, place);
    const int planes = image.channels();
    picture.resize(checked_shape(static_cast<std::uint64_t>(image.rows),
                                 static_cast<std::uint64_t>(image.cols),
                                 static_cast<std::uint64_t>(planes), place));
    picture.traits = {.gamma_coded = png.gamma_coded, .has_alpha = png.has_alpha};
    const auto bytes = std::as_bytes(std::span(image.data, image.total() * image.elemSize()));
    const InterleavedOrder order{planes, true};
    if (image.depth() == CV_16U)
        split_planes<std::uint16_t>(bytes, order, planes, picture.values, UnitScale());
    else
        split_planes<std::uint8_t>(bytes, order, planes, picture.values, UnitScale());
}

}  // namespace

void to_picture(const TiffPixels& pixels, Picture& picture) {
    using Sample = TiffPixels::Sample;
    const int planes = pixels.shape.planes;
    picture.resize(pixels.shape);
    picture.traits = {.gamma_coded = planes == 3 && pixels.sample == Sample::kU8,
                      .floating = pixels.sample == Sample::kF32,
                      .has_alpha = pixels.channels > planes};
    const auto split = [&]<typename Stored>(Stored, auto to_float) {
        split_planes<Stored>(pixels.bytes, {pixels.channels}, planes, picture.values, to_float);
    };
    switch (pixels.sample) {
        case Sample::kU8:
            return split(std::uint8_t{}, UnitScale());
        case Sample::kU16:
            return split(std::uint16_t{}, UnitScale());
        case Sample::kF32:
            return split(float{}, [](float value) { return value; });
    }
}

void read_image(const std::filesystem::path& file, Picture& picture) {
    switch (image_format(file)) {
        case ImageFormat::kPng:
            return read_png(file.string(), picture);
        case ImageFormat::kTiff:
            return to_picture(read_single_tiff(file), picture);
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
