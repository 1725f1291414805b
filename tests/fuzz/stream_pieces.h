#pragma once

#include "tests/fuzz/framed_file.h"

namespace stipple {

/// Bytes of a header before its texts.
inline constexpr std::size_t kStreamHeadBytes = 92;

/// True if the header asks for the random schedule of a large array, or may switch to one, which
/// takes a while.
[[nodiscard]] bool asks_for_much(std::span<const std::uint8_t> bytes);

/// The sample stream: header, packets, end marker.
extern const FramedFormat kStreamFormat;

}  // namespace stipple
