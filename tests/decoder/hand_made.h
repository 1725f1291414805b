#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "decoder/measurements.h"

namespace stipple {

/// One pixel.
inline constexpr FrameShape kSite{.rows = 1, .cols = 1, .planes = 1};

/// A sample written by hand.
struct HandSample {
    std::size_t site = 0;
    int first_slot = 0;
    std::uint64_t open_slots = 1;
    float light = 0;
    bool saturated = false;
};

/// Measurements that hold these samples; all else is unobserved.
inline Measurements hand_made(int slots, FrameShape shape, const std::vector<HandSample>& samples) {
    const std::size_t voxels = static_cast<std::size_t>(slots) * shape.sites();
    Measurements m{.slots = slots,
                   .shape = shape,
                   .state = std::vector<std::uint8_t>(voxels),
                   .sum = std::vector<float>(voxels),
                   .variance = std::vector<float>(voxels, 1e-4F)};
    for (const HandSample& sample : samples) {
        const auto voxel = [&](int slot) {
            return static_cast<std::size_t>(sample.first_slot + slot) * shape.sites() + sample.site;
        };
        const auto span = static_cast<int>(std::bit_width(sample.open_slots));
        for (int slot = 0; slot < span; ++slot)
            if ((sample.open_slots >> static_cast<unsigned>(slot) & 1U) != 0)
                m.state[voxel(slot)] |= Measurements::kOpen;
        m.state[voxel(0)] |= Measurements::kFirst;
        m.state[voxel(span - 1)] |= Measurements::kLast;
        if (sample.saturated) m.state[voxel(span - 1)] |= Measurements::kSaturated;
        m.sum[voxel(span - 1)] = sample.light;
    }
    return m;
}

}  // namespace stipple
