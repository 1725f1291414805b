#pragma once

#include <cstdint>
#include <span>

#include "decoder/reconstruct.h"

namespace stipple {

/// The halo of the block whose core begins at `core_begin`, by the exposures that may reach into
/// it. Switches of the schedule count up to the last slot that a block may need, whether later ones
/// are known or not. At most max_halo_slots.
[[nodiscard]] std::int64_t halo_at(std::span<const RigStream> rig, std::int64_t core_begin);
/// The same of one sensor.
[[nodiscard]] std::int64_t halo_at(const StreamHeader& header, std::int64_t core_begin);
[[nodiscard]] std::int64_t max_halo_slots(std::span<const RigStream> rig);

/// Slots that `decode_rig` computes to deliver the first `frames` of `slots`: whole blocks.
/// Precondition: 0 <= frames <= slots.
[[nodiscard]] std::int64_t computed_slots(std::int64_t frames, std::int64_t slots);

/// A block of slots and its halo.
struct BlockCost {
    std::uint64_t voxels = 0;  ///< of its largest tile
    std::uint64_t bytes = 0;   ///< of memory, at most
};

/// A block of `block_slots` slots, of which `core_slots` are delivered.
[[nodiscard]] BlockCost block_cost(std::span<const RigStream> rig, DecodeMethod method,
                                   std::int64_t block_slots, std::int64_t core_slots);

struct DecodeCost {
    double seconds = 0;       ///< with the present threads on idle cores of about 3 GHz
    std::uint64_t bytes = 0;  ///< of memory, at most
};

/// What `decode_rig` takes for the first `slots` slots of streams.
[[nodiscard]] DecodeCost expected_cost(std::span<const RigStream> rig, DecodeMethod method,
                                       std::int64_t slots);

}  // namespace stipple
