#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stipple {

/// The file that Aravis takes from a zip file: the last one of its directory. Empty if part of the
/// directory or of a file lies outside of `zip`, or a file has more than `max_bytes`.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> unzipped_description(
    std::span<const std::uint8_t> zip, std::size_t max_bytes);

}  // namespace stipple
