#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stipple {

/// What a served camera does wrong on purpose, for tests of its clients. The same seed makes the
/// same faults.
struct GvspFaults {
    double drop = 0;       ///< share of packets that are not sent until they are asked for again
    double lose = 0;       ///< share of packets that are never sent
    double duplicate = 0;  ///< share of packets that are sent twice
    bool reorder = false;  ///< every fourth packet changes places with the next
    std::optional<std::uint64_t> gap_at = {};     ///< frame before which ids are left out
    std::uint64_t gap_frames = 0;                 ///< how many
    std::uint16_t first_block = 1;                ///< block id of the first frame, 1 to 65535
    std::optional<std::uint64_t> freeze_at = {};  ///< frame from which on nothing is sent
    std::uint64_t seed = 1;
};

/// Whether packet `index` of frame `number` is never sent.
[[nodiscard]] bool is_lost(const GvspFaults& faults, std::uint64_t number, std::uint32_t index);

/// The packets of a frame in the order in which they are sent.
[[nodiscard]] std::vector<std::uint32_t> packets_to_send(const GvspFaults& faults,
                                                         std::uint64_t number,
                                                         std::uint32_t packets);

/// The number that a frame has on the wire: after the gap, if there is one.
[[nodiscard]] std::uint64_t number_with_gap(const GvspFaults& faults, std::uint64_t number);

}  // namespace stipple
