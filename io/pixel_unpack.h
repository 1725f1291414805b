#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/pixel_format.h"

namespace stipple {

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
