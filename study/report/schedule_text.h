#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/schedules/schedule_figures.h"

namespace stipple {

/// For programs.
[[nodiscard]] nlohmann::ordered_json figures_json(const std::string& name,
                                                  const ScheduleFigures& figures);
/// For people: some lines.
[[nodiscard]] std::string figures_text(const std::string& name, const ScheduleFigures& figures);

/// A pixel of the array.
struct ArrayPixel {
    int row = 0;
    int col = 0;
};

/// `count` pixels of an array that show what a schedule does: spread evenly over the tile or, where
/// it has fewer, of it and those to its right. Fewer if the array ends before.
[[nodiscard]] std::vector<ArrayPixel> sample_pixels(const ExposureSchedule& schedule,
                                                    FrameShape array, int count);

/// A ruler, a line per charge store of each pixel with a character per slot of [0, slots), and what
/// the characters say: '-' open, '.' closed; where an exposure is read, the slots it was open, '#'
/// for ten or more. The period before counts too.
[[nodiscard]] std::string diagram_text(const ExposureSchedule& schedule,
                                       const std::vector<ArrayPixel>& pixels, int slots);

/// The timing diagram of a recording that begins with slot 0: `count` pixels, spread over the tile
/// (sample_pixels), each with `row`, `col` and `exposures`: those that begin in [0, slots), as
/// [first slot, charge store, span, [[first open, open slots], ...]].
[[nodiscard]] nlohmann::ordered_json lanes_json(const ExposureSchedule& schedule, FrameShape array,
                                                int count, std::int64_t slots);

/// The runs of set bits of `Exposure::open_slots` as [first, length].
[[nodiscard]] nlohmann::ordered_json open_runs_json(std::uint64_t open_slots);

}  // namespace stipple
