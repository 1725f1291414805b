#include "io/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
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

void read_png(const std::filesystem::path& file, Image& image) {
    const std::string where = file.string();
    const PngImage png = decode_png(read_file(where), where);
    const PngPixels& pixels = png.pixels;
    const int planes = pixels.channels;
    image.resize({pixels.rows, pixels.cols, planes});
    image.traits = png.traits;
    const auto bytes = std::as_bytes(std::span(pixels.bytes));
    if (pixels.bytes_per_sample == 2)
        split_planes<std::uint16_t>(bytes, planes, planes, image.values, UnitScale());
    else
        split_planes<std::uint8_t>(bytes, planes, planes, image.values, UnitScale());
}

constexpr std::array kReaders{
    ImageReader{"PNG", {".png"}, read_png},
    ImageReader{"TIFF",
                {".tif", ".tiff"},
                [](const std::filesystem::path& file, Image& image) {
                    to_image(read_single_tiff(file), image);
                }},
    ImageReader{"EXR", {".exr"}, read_exr},
    ImageReader{"DNG", {".dng"}, read_dng},
};

}  // namespace

void to_image(const TiffPixels& pixels, Image& image) {
    using Sample = TiffPixels::Sample;
    const int planes = pixels.shape.planes;
    image.resize(pixels.shape);
    const bool is_float = pixels.sample == Sample::kF32;
    const bool is_picture = planes == 3 && pixels.sample == Sample::kU8;
    image.traits = {.gamma_coded = is_picture || (pixels.has_profile && !is_float),
                    .floating = is_float,
                    .has_alpha = pixels.channels > planes,
                    .frames_hz = pixels.times.frames_hz,
                    .warnings = pixels.times.warnings};
    const auto sample_bits = 8 * static_cast<int>(pixels.sample_bytes());
    image.traits.sample_format = fmt::format("{}{}", is_float ? "float" : "uint", sample_bits);
    if (!is_float) image.traits.bits = sample_bits;
    const auto split = [&]<typename Stored>(Stored, auto to_float) {
        split_planes<Stored>(pixels.bytes, pixels.channels, planes, image.values, to_float);
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

std::span<const ImageReader> image_readers() {
    return kReaders;
}

const ImageReader* image_reader(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension.empty()) return nullptr;
    for (const ImageReader& reader : kReaders)
        if (std::ranges::find(reader.extensions, extension) != reader.extensions.end())
            return &reader;
    return nullptr;
}

std::string image_format_names() {
    std::string names;
    for (std::size_t i = 0; i < kReaders.size(); ++i)
        names += fmt::format("{}{}",
                             i == 0                    ? ""
                             : i + 1 < kReaders.size() ? ", "
                                                       : " or ",
                             kReaders[i].name);
    return names;
}

void read_image(const std::filesystem::path& file, Image& image) {
    refuse_special(file);
    const ImageReader* const reader = image_reader(file);
    if (reader == nullptr)
        throw InputError(file.string(), fmt::format("is not an image that can be read; give {}",
                                                    image_format_names()));
    reader->read(file, image);
}

void write_png(const std::filesystem::path& file, const std::string& where, FrameShape shape,
               std::span<const float> frame) {
    assert(frame.size() == shape.sites());
    PngPixels pixels{.rows = shape.rows,
                     .cols = shape.cols,
                     .channels = shape.planes,
                     .bytes = std::vector<std::uint8_t>(shape.sites())};
    tone_map_frame(frame, shape, pixels.bytes);
    write_png_file(file, pixels, where);
}

}  // namespace stipple
