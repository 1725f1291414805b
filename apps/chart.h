#pragma once

#include <filesystem>
#include <string>

namespace stipple {

/// Size of a chart: pixels of a PNG, the same numbers in an SVG.
struct ChartSize {
    int width = 960;
    int height = 640;
};

/// Draws a chart with gnuplot. `commands` are gnuplot's (data in here-documents, `$points << END`);
/// terminal and output are set here from the extension of `file`, .png or .svg.
/// \throws InputError for another extension, DeviceError if gnuplot is not installed or fails, with
/// what it said.
void draw_chart(const std::filesystem::path& file, ChartSize size, const std::string& commands);

}  // namespace stipple
