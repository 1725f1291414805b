#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stipple {

/// Simulated faults of a served camera, for tests of clients. The same seed gives the same faults.
struct GvspFaults {
    double drop = 0;       ///< share of packets that are sent on a resend request only
    double lose = 0;       ///< share of packets that are never sent
    double duplicate = 0;  ///< share of packets that are sent twice
    bool reorder = false;  ///< every fourth packet is swapped with the next
    std::optional<std::uint64_t> gap_at = {};     ///< frame before which ids are skipped
    std::uint64_t gap_frames = 0;                 ///< number of skipped ids
    std::uint16_t first_block = 1;                ///< block id of the first frame, 1 to 65535
    std::uint64_t begin_at = 0;                   ///< frame before which nothing is sent
    std::optional<std::uint64_t> freeze_at = {};  ///< frame from which on nothing is sent
    std::uint64_t seed = 1;
};

/// Whether packet `index` of frame `number` is never sent.
[[nodiscard]] bool is_lost(const GvspFaults& faults, std::uint64_t number, std::uint32_t index);

/// Indices of the packets of a frame in the order of sending.
[[nodiscard]] std::vector<std::uint32_t> packets_to_send(const GvspFaults& faults,
                                                         std::uint64_t number,
                                                         std::uint32_t packets);

/// The number of a frame on the wire, with the gap added.
[[nodiscard]] std::uint64_t number_with_gap(const GvspFaults& faults, std::uint64_t number);

}  // namespace stipple
