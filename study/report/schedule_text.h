#pragma once

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

}  // namespace stipple
