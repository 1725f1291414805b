#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {

/// Collects the exposures of a tile, pixel by pixel.
class ScheduleBuilder {
  public:
    ScheduleBuilder(int rows, int cols, int period_slots)
        : rows_(rows), cols_(cols), period_slots_(period_slots) {}

    /// Adds `open_slots` slots (bit 0 is set) from `slot`, which may lie beyond the period.
    void add(std::uint32_t slot, std::uint64_t open_slots) {
        exposures_.push_back({slot % static_cast<std::uint32_t>(period_slots_), open_slots});
    }
    /// Adds `slots` slots without gaps, 1..64.
    void add_open(std::uint32_t slot, int slots) { add(slot, open_without_gap(slots)); }
    void end_pixel() { first_.push_back(static_cast<std::uint32_t>(exposures_.size())); }

    /// \throws InputError as ExposureSchedule. Precondition: `end_pixel` was called for each pixel.
    [[nodiscard]] ExposureSchedule schedule() && {
        return {rows_, cols_, period_slots_, std::move(first_), std::move(exposures_)};
    }

  private:
    int rows_;
    int cols_;
    int period_slots_;
    std::vector<std::uint32_t> first_ = {0};
    std::vector<Exposure> exposures_;
};

}  // namespace stipple
