#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace stipple {

/// Code 1 stands for this light; less is code 0, no light.
inline constexpr double kDarkestCodedLight = 1.0 / 16384;
/// Neighbouring codes differ by 2^(1/128), 0.54 %.
inline constexpr int kCodesPerStop = 128;

/// Light on a logarithmic scale: 1 + round(128 log2(light / kDarkestCodedLight)), 0 for less light
/// and for NaN. The light of a code is within 0.27 % of what was coded.
[[nodiscard]] std::uint16_t light_code(float light) noexcept;
/// The light of a code.
[[nodiscard]] double light_of_code(std::uint16_t code) noexcept;

/// `values` as text for the page: the difference of each value from that `step` before it (modulo
/// 2^16, the first ones from 0) with its sign in the lowest bit (2 d, or -2 d - 1 below 0), all low
/// bytes and then all high bytes, deflated (zlib), in base64. page/planes.js reads it. `step` > 1:
/// values of so many colours take turns.
[[nodiscard]] std::string packed_plane(std::span<const std::uint16_t> values, std::size_t step = 1);

}  // namespace stipple
