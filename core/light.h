#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/geometry.h"
#include "core/named_value.h"

namespace stipple {

/// Transfer function from the values of a footage file to light.
enum class Transfer {
    kLinear,   ///< proportional to light
    kGamma22,  ///< light = value^2.2
    kSrgb,     ///< IEC 61966-2-1
    kBt709,    ///< ITU-R BT.709-6 and BT.2020: light before the camera
    kPq,       ///< SMPTE ST 2084: 203 cd/m2 is light 1.0 (core/hdr_curves.h)
    kHlg,      ///< ARIB STD-B67: light before the camera; 1.0 where a display shows 203 cd/m2
    kAuto,     ///< the one that the file declares
};

/// On the command line, in Python and in provenance.
inline constexpr auto kTransfers =
    std::to_array<NamedValue<Transfer>>({{"linear", Transfer::kLinear},
                                         {"gamma22", Transfer::kGamma22},
                                         {"srgb", Transfer::kSrgb},
                                         {"bt709", Transfer::kBt709},
                                         {"pq", Transfer::kPq},
                                         {"hlg", Transfer::kHlg},
                                         {"auto", Transfer::kAuto}});

[[nodiscard]] constexpr std::string_view name_of(Transfer transfer) {
    return name_in(kTransfers, transfer);
}

/// The shape of rows x cols x planes. \throws InputError at `where` unless 1 <= rows,
/// cols <= kMaxFrameSide, planes is 1 or 3 and there are at most kMaxFrameSites.
[[nodiscard]] FrameShape checked_shape(std::uint64_t rows, std::uint64_t cols, std::uint64_t planes,
                                       std::string_view where);

/// Max compression ratio of Deflate (equal bytes). Other compressions of images do not reach it
/// unless noted.
inline constexpr std::uint64_t kDeflateRatio = 1032;

/// \throws InputError at `where` if an image of `bytes` exceeds 2 x `ratio` x `file_bytes`, the max
/// content of a file with this compression ratio (factor 2 for headers). Call it before taking
/// memory.
void check_packed(std::uint64_t bytes, std::uint64_t file_bytes, std::string_view where,
                  std::uint64_t ratio = kDeflateRatio);

/// Converts encoded values to light, in place. Values below 0 are unchanged. Precondition: not
/// kAuto.
void linearise(std::span<float> values, Transfer transfer);

/// \throws InputError naming place, row, column and plane of the first value that is NaN,
/// infinite or, unless `negative` allows it, negative.
void check_light(std::span<const float> light, FrameShape shape, std::string_view where,
                 bool negative = false);

/// Multiplies light by `factor`, in place. \throws InputError if light becomes infinite.
void scale_light(std::span<float> light, double factor, std::string_view where);

/// Rec. 709 luminance .2126 R + .7152 G + .0722 B of `rgb` (order (plane, row, col)).
/// Precondition: rgb.size() == 3 * luminance.size().
void reduce_to_luminance(std::span<const float> rgb, std::span<float> luminance);

}  // namespace stipple
