#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"

namespace stipple {

/// Figures of a schedule in steady slots.
struct ScheduleFigures {
    int tile_rows = 0;
    int tile_cols = 0;
    int period_slots = 0;
    double compression_ratio = 0;  ///< slots of a pixel per sample; infinite if nothing is read
    double light_throughput = 0;   ///< fraction of all (pixel, slot) pairs that collect light
    int min_exposures = 0;         ///< of a pixel in a period
    int max_exposures = 0;
    std::uint64_t min_due = 0;  ///< pixels of the array that are read in a slot
    std::uint64_t max_due = 0;
    double mean_due = 0;
    int charge_stores = 0;               ///< that a pixel needs
    std::uint64_t code_memory_bits = 0;  ///< of the tile on the chip (docs/sequencer_program.md)
};

/// Figures for an array of `shape`; run time grows with its rows and the period.
[[nodiscard]] ScheduleFigures schedule_figures(const ExposureSchedule& schedule, FrameShape shape);

}  // namespace stipple
