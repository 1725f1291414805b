#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/hdr_curves.h"

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

/// How light becomes the numbers of a video.
enum class VideoCurve {
    kSdr,  ///< tone-mapped to 8 bits (io/tone_map.h)
    kPq,   ///< luminance, 10 bits: SMPTE ST 2084
    kHlg,  ///< light relative to a peak, 10 bits: ARIB STD-B67
};

/// Of 10 bits; 8 bits are H.264.
enum class HdrCodec { kHevc, kAv1 };

struct VideoCoding {
    VideoCurve curve = VideoCurve::kSdr;
    bool uncompressed = false;  ///< .y4m; by the name of the output
    HdrCodec codec = HdrCodec::kHevc;
    double frames_hz = 30;                   ///< of playback
    double cd_per_unit = kReferenceWhiteCd;  ///< luminance of light 1.0, in cd/m2
    double peak_cd = 1000;                   ///< PQ: brighter light is clipped to it
};

/// Light of a video in PQ, as CTA-861.3 defines it, in cd/m2.
struct LightLevels {
    double max_cll = 0;           ///< of the brightest pixel: the largest of its R, G and B
    double max_fall = 0;          ///< of the brightest frame: the mean of these
    double clipped_fraction = 0;  ///< of the values, above the peak
};

}  // namespace stipple
