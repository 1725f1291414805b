#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"
#include "study/report/schedule_text.h"

namespace stipple {

/// Content of a timing diagram: slots [0, slots) of these pixels, after the first exposures.
struct ScheduleDiagram {
    std::string name;
    const ExposureSchedule& schedule;
    std::vector<ArrayPixel> pixels;
    int slots;
};

/// Draws a timing diagram in the manner of Figure 1 of Portz, Zhang, Jiang (ICCP 2013): a row per
/// pixel, a box per stretch of open slots, its colour that of the exposure's light. Exposures with
/// gaps have a line from their first to their last slot, and a dot at their readout; those of
/// the second charge store are in the lower half of a row, which is labelled. \throws InputError
/// for a name that ends neither in .png nor in .svg or exists and not `force`; DeviceError if
/// gnuplot fails.
void draw_schedule(const std::filesystem::path& file, bool force, const ScheduleDiagram& diagram);

}  // namespace stipple
