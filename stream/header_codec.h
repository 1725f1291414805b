#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "stream/framing.h"
#include "stream/header_sections.h"
#include "stream/stream_header.h"

namespace stipple {

/// First bytes of a file, which hold the length of its header.
inline constexpr std::size_t kHeaderStartBytes = 16;

/// The bytes of a header. \throws InputError at `where` if a field is outside its limits.
[[nodiscard]] std::vector<std::uint8_t> encode_header(const StreamHeader& header,
                                                      std::string_view where);

/// Whether the first bytes of a file are those of a stream of any version.
[[nodiscard]] bool begins_as_stream(std::span<const std::uint8_t> start);

/// Length of a header. `start`: the first `kHeaderStartBytes` bytes of a file, or the whole file.
/// \throws InputError naming file and offset if it is no sample stream or of an unknown version.
[[nodiscard]] std::size_t header_bytes(std::span<const std::uint8_t> start, std::string_view where);

/// Precondition: header.size() == header_bytes(start of header).
[[nodiscard]] Framing framing_of(std::span<const std::uint8_t> header);

/// The inverse of `encode_header`. Precondition: header.size() == header_bytes(start of header).
/// \throws InputError naming file and offset, or as check_memory.
[[nodiscard]] StreamHeader decode_header(std::span<const std::uint8_t> header,
                                         std::string_view where, const ScheduleUse& use = {});

}  // namespace stipple
