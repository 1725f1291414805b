#pragma once

#include <bit>
#include <random>
#include <utility>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/index.h"

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

/// A schedule of two-bucket pixels: every slot of a code belongs to one exposure or the other, or
/// to none; a code goes around the period, so exposures begin anywhere. Where it holds an odd
/// number of exposures that all overlap their neighbours, stores change sides from period to
/// period.
inline ExposureSchedule interleaved_schedule(int tile_rows, int tile_cols, int code_slots,
                                             std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto period = static_cast<std::uint32_t>(3 * code_slots);
    std::vector<std::uint32_t> first = {0};
    std::vector<Exposure> exposures;
    for (int pixel = 0; pixel < tile_rows * tile_cols; ++pixel) {
        const auto offset = static_cast<std::uint32_t>(random() % period);
        for (int code = 0; code < 3; ++code) {
            std::uint64_t masks[2] = {0, 0};  // of the code's slots
            for (int slot = 0; slot < code_slots; ++slot)
                if (const auto store = random() % 5; store < 4)
                    masks[store % 2] |= std::uint64_t{1} << static_cast<unsigned>(slot);
            for (const std::uint64_t mask : masks) {
                if (mask == 0 || pixel % 7 == 3) continue;
                const auto closed = static_cast<std::uint32_t>(std::countr_zero(mask));
                const auto begin = offset + static_cast<std::uint32_t>(code * code_slots) + closed;
                exposures.push_back({begin % period, mask >> closed});
            }
        }
        first.push_back(static_cast<std::uint32_t>(exposures.size()));
    }
    return {tile_rows, tile_cols, static_cast<int>(period), first, exposures};
}

/// Three exposures of four slots, each begun two slots after the last: the stores alternate.
inline ExposureSchedule alternating_schedule() {
    return {1, 1, 6, {0, 3}, {{0, 0b1001}, {2, 0b1001}, {4, 0b1001}}};
}

/// The same exposures behind a grey mask: weights of 0.25 to 1.25.
inline ExposureSchedule weighted_schedule(ExposureSchedule schedule, std::uint32_t seed) {
    std::mt19937 random(seed);
    const int rows = schedule.tile_rows(), cols = schedule.tile_cols();
    std::vector<float> weights(index(schedule.period_slots()) * index(rows) * index(cols), 0.0F);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            for (const Exposure& e : schedule.exposures(row, col))
                for (std::uint64_t rest = e.open_slots; rest != 0; rest &= rest - 1) {
                    const auto slot = e.first_slot + static_cast<unsigned>(std::countr_zero(rest));
                    const auto phase = static_cast<int>(slot) % schedule.period_slots();
                    weights[row_major(phase * rows + row, col, cols)] =
                        0.25F + static_cast<float>(random() >> 8U) * 0x1p-24F;
                }
    schedule.set_weights(std::move(weights));
    return schedule;
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
