#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"

namespace stipple {

/// What a schedule costs and gives, once the first exposures are over.
struct ScheduleFigures {
    int tile_rows = 0;
    int tile_cols = 0;
    int period_slots = 0;
    double compression_ratio = 0;  ///< slots of a pixel per sample; infinite if nothing is read
    double light_throughput = 0;   ///< part of all pixels and slots that collects light
    int min_exposures = 0;         ///< of a pixel in a period
    int max_exposures = 0;
    std::uint64_t min_due = 0;  ///< pixels of the array that are read in a slot
    std::uint64_t max_due = 0;
    double mean_due = 0;
    int charge_stores = 0;               ///< that a pixel needs
    std::uint64_t code_memory_bits = 0;  ///< on chip, as docs/sequencer_program.md packs the tile
};

/// Of an array of `shape`; time grows with its rows and the period.
[[nodiscard]] ScheduleFigures schedule_figures(const ExposureSchedule& schedule, FrameShape shape);

}  // namespace stipple
