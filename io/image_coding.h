#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace stipple {

enum class ImageFormat { kPng, kTiff, kExr };

/// Numbers of an image.
enum class SampleKind {
    kFloat,  ///< IEEE 754, 32 bits: light
    kHalf,   ///< IEEE 754, 16 bits: light, up to 65504
    kWord,   ///< integers of 16 bits: 65535 is light `full_scale`, brighter light is clipped
};

/// How light becomes images: those of a folder, and the pages of a TIFF stack.
struct ImageCoding {
    ImageFormat format = ImageFormat::kExr;  ///< of a folder
    std::optional<SampleKind> samples = {};  ///< none: kFloat, of PNG kWord
    double full_scale = 1;
    double slot_s = 0;    ///< seconds from frame to frame, for TIFF stacks; 0: unknown
    double pixel_um = 0;  ///< size of a pixel in micrometres, for TIFF stacks; 0: unknown
};

/// The number of `light`, 0..65535. NaN and negative light are 0.
[[nodiscard]] std::uint16_t to_uint16(float light, double full_scale);

/// A frame (plane, row, col) as interleaved samples of kFloat or kWord in the byte order of the
/// machine. Precondition: coding.samples is one of these.
void interleave(std::span<const float> frame, FrameShape shape, const ImageCoding& coding,
                std::vector<std::byte>& bytes);

}  // namespace stipple
