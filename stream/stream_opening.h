#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "stream/buffered_reader.h"
#include "stream/due_count.h"
#include "stream/packet_codec.h"
#include "stream/stream_header.h"
#include "stream/stream_reader.h"

namespace stipple {

/// What a stream says before its first packet.
struct StreamOpening {
    StreamHeader header;
    Framing framing;
    std::optional<DueCounts> counts;  ///< kCounts, of a random schedule
    bool counting = false;            ///< kCounts
};

/// Size of a file that is not followed; else kEndlessInput.
[[nodiscard]] std::uint64_t bytes_of(const BufferedReader& window, const WaitForMore& wait);

/// Reads the header of a stream, for which it waits; leaves `window` at the first packet.
/// \throws InputError as StreamReader.
[[nodiscard]] StreamOpening open_stream_header(BufferedReader& window, const std::string& where,
                                               ReadPolicy policy, const WaitForMore& wait);

}  // namespace stipple
