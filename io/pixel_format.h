#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/colour_filter.h"

namespace stipple {

/// How the samples of a row lie in memory. The numbers are those of docs/recording_format.md.
enum class Packing : std::uint8_t {
    kBytes = 0,             ///< 1 byte a sample, or 2, little-endian, significant bits lowest
    kBytesBigEndian = 1,    ///< 2 bytes a sample, big-endian (V4L2 Y16_BE)
    kLsbPacked = 2,         ///< PFNC "p": a bit string, each sample from its lowest bit on
    kGigEVisionPacked = 3,  ///< GigE Vision "Packed": two samples in 3 bytes, their low bits in the
                            ///< middle
    kMipiPacked = 4,        ///< MIPI CSI-2, V4L2 "P": the high 8 bits of 4 (10, 14 bit) or 2 (12
                            ///< bit) samples, then their low bits as a bit string
    kMsbPacked = 5,         ///< a bit string, each sample from its highest bit on, as in TIFF; of
                            ///< files only, cameras have no such format
};

/// A pixel format as cameras send it. Everything that is not in `pixel_formats()` is refused:
/// nothing is converted on the way in.
struct PixelFormat {
    std::string_view name;   ///< GenICam PFNC name ("Mono12p", "BayerRG10"), or V4L2's in its style
    std::uint32_t pfnc = 0;  ///< PFNC code, 0 if it has none
    std::uint32_t v4l2 = 0;  ///< V4L2 fourcc, 0 if it has none
    int bits_per_pixel = 0;  ///< in memory, all planes together
    int significant_bits = 0;  ///< of a sample: 8 to 16
    Packing packing = Packing::kBytes;
    ColourFilter filter = ColourFilter::kNone;
    int planes = 1;  ///< 3 for interleaved RGB

    /// Bytes of a row of `width` pixels without padding at its end: whole bytes, of kMipiPacked
    /// whole groups, rounded up.
    [[nodiscard]] std::size_t row_bytes(int width) const;
};

/// All formats that are read, in the order of the documentation.
[[nodiscard]] std::span<const PixelFormat> pixel_formats();

/// The format of that name, code or fourcc; nullptr if it is none of ours.
[[nodiscard]] const PixelFormat* pixel_format_named(std::string_view name);
[[nodiscard]] const PixelFormat* pixel_format_of_pfnc(std::uint32_t code);
[[nodiscard]] const PixelFormat* pixel_format_of_v4l2(std::uint32_t fourcc);

/// The samples of a row of pixels, by column and plane, as the numbers that the camera sent: 0 to
/// 2^significant_bits - 1, and beyond only where the device sets bits that should be 0.
/// Precondition: samples.size() is a multiple of format.planes; row.size() >=
/// format.row_bytes(samples.size() / planes).
void unpack_row(const PixelFormat& format, std::span<const std::uint8_t> row,
                std::span<std::uint16_t> samples) noexcept;

/// The light of each number that a sample can hold: max(0, DN - black) / (white - black).
/// Precondition: black_dn < white_dn.
[[nodiscard]] std::vector<float> light_table(const PixelFormat& format, double black_dn,
                                             double white_dn);

}  // namespace stipple
