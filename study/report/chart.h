#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace stipple {

/// gnuplot cannot be run, which charts need.
class NoGnuplot : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// Size of a chart: pixels of a PNG, the same numbers in an SVG.
struct ChartSize {
    int width = 960;
    int height = 640;
};

/// The content of the file that gnuplot draws. `commands` are gnuplot's (data in here-documents,
/// `$points << END`); terminal and output are set here from the `extension`, ".png" or ".svg".
/// \throws NoGnuplot, DeviceError with the message of gnuplot.
[[nodiscard]] std::string draw_chart(std::string_view extension, ChartSize size,
                                     const std::string& commands);

}  // namespace stipple
