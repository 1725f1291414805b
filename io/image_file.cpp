#include "io/image_file.h"

#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/input_file.h"
#include "core/light.h"
#include "io/dng_file.h"
#include "io/exr_file.h"
#include "io/footage_files.h"
#include "io/interleaved.h"
#include "io/png_file.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

void read_png(const std::string& place, Picture& picture) {
    const PngImage png = decode_png(read_file(place), place);
    const PngPixels& pixels = png.pixels;
    const int planes = pixels.channels;
    picture.resize({pixels.rows, pixels.cols, planes});
    picture.traits = png.traits;
    const auto bytes = std::as_bytes(std::span(pixels.bytes));
    if (pixels.bytes_a_sample == 2)
        split_planes<std::uint16_t>(bytes, planes, planes, picture.values, UnitScale());
    else
        split_planes<std::uint8_t>(bytes, planes, planes, picture.values, UnitScale());
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
        split_planes<Stored>(pixels.bytes, pixels.channels, planes, picture.values, to_float);
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
    refuse_special(file);
    switch (image_format(file)) {
        case ImageFormat::kPng:
            return read_png(file.string(), picture);
        case ImageFormat::kTiff:
            return to_picture(read_single_tiff(file), picture);
        case ImageFormat::kExr:
            return read_exr(file, picture);
        case ImageFormat::kDng:
            return read_dng(file, picture);
        case ImageFormat::kNone:
            break;
    }
    throw InputError(file.string(),
                     "is not a picture that can be read; give PNG, TIFF, EXR or DNG");
}

void write_png(const std::filesystem::path& file, FrameShape shape, std::span<const float> frame) {
    assert(frame.size() == shape.sites());
    PngPixels pixels{.rows = shape.rows,
                     .cols = shape.cols,
                     .channels = shape.planes,
                     .bytes = std::vector<std::uint8_t>(shape.sites())};
    tone_map_frame(frame, shape, pixels.bytes);
    write_png_file(file, pixels);
}

}  // namespace stipple
