#pragma once

#include <string_view>

namespace stipple::page {

// The files of page/, embedded by cmake/EmbedFiles.cmake.

extern const std::string_view kHtml;
extern const std::string_view kStyle;
extern const std::string_view kProgram;  ///< all .js files, one after the other
extern const std::string_view kCharts;  ///< Chart.js, minified; empty if the build has not found it

}  // namespace stipple::page
