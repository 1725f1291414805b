#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/geometry.h"

namespace stipple {

/// How the numbers of a footage file map to light.
enum class Transfer {
    kLinear,   ///< proportional to light
    kGamma22,  ///< light = value^2.2
    kSrgb,     ///< IEC 61966-2-1
};

/// Largest frame that the sample stream can carry (docs/stream_format.md).
inline constexpr std::uint64_t kMaxFrameSide = 65535;
inline constexpr std::uint64_t kMaxFrameSites = std::uint64_t{1} << 28U;

/// The shape of rows x cols x planes. \throws InputError at `place` unless 1 <= rows,
/// cols <= 65535, planes is 1 or 3 and there are at most 2^28 sites.
[[nodiscard]] FrameShape checked_shape(std::uint64_t rows, std::uint64_t cols, std::uint64_t planes,
                                       std::string_view place);

/// What Deflate makes of bytes that are all alike, and the other ways in which pictures are packed
/// do not reach, but those that say so.
inline constexpr std::uint64_t kDeflateRatio = 1032;

/// \throws InputError at `place` if a picture of `bytes` is more than a file of `file_bytes`,
/// packed `ratio` times, can hold (by more than a factor of 2: headers). Said before memory is
/// taken.
void check_packed(std::uint64_t bytes, std::uint64_t file_bytes, std::string_view place,
                  std::uint64_t ratio = kDeflateRatio);

/// Turns encoded values into light, in place. Values below 0 stay as they are.
void linearise(std::span<float> values, Transfer transfer);

/// \throws InputError naming place, row, column and plane of the first value that is NaN,
/// infinite or negative.
void check_light(std::span<const float> light, FrameShape shape, std::string_view place);

/// Rec. 709 luminance .2126 R + .7152 G + .0722 B of `rgb` (order (plane, row, col)).
/// Precondition: rgb.size() == 3 * luminance.size().
void reduce_to_luminance(std::span<const float> rgb, std::span<float> luminance);

}  // namespace stipple
