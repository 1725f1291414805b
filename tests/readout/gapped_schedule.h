#pragma once

#include <random>
#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {

/// A schedule without interleaving whose pixels pause between exposures and flutter within them:
/// any rest, any mask of up to 12 slots, from any offset; some pixels are never read.
inline ExposureSchedule gapped_schedule(int tile_rows, int tile_cols, int period_slots,
                                        std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t range) {
        return static_cast<std::uint32_t>(random() % range);
    };
    const auto period = static_cast<std::uint32_t>(period_slots);
    std::vector<std::uint32_t> first = {0};
    std::vector<Exposure> exposures;
    for (int pixel = 0; pixel < tile_rows * tile_cols; ++pixel) {
        const std::uint32_t offset = below(period);
        for (std::uint32_t slot = below(6); slot < period; slot += below(4)) {
            const std::uint64_t mask = below(1U << 12U) | 1U;
            const Exposure e{(offset + slot) % period, mask};
            slot += static_cast<std::uint32_t>(e.span_slots());
            if (slot <= period && pixel % 7 != 3) exposures.push_back(e);
        }
        first.push_back(static_cast<std::uint32_t>(exposures.size()));
    }
    return {tile_rows, tile_cols, period_slots, first, exposures};
}

/// One exposure of a pixel as it happened.
struct TakenExposure {
    std::int64_t begin_slot;
    Exposure exposure;
    [[nodiscard]] std::int64_t last_slot() const { return begin_slot + exposure.span_slots() - 1; }
};

/// All exposures of pixel (row, col) that begin in slots [0, slots), straight from the definition.
inline std::vector<TakenExposure> taken_exposures(const ExposureSchedule& schedule, int row,
                                                  int col, int slots) {
    std::vector<TakenExposure> taken;
    for (const Exposure& e :
         schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols()))
        for (std::int64_t begin = e.first_slot; begin < slots; begin += schedule.period_slots())
            taken.push_back({begin, e});
    return taken;
}

}  // namespace stipple
