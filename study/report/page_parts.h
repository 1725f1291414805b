#pragma once

#include <string_view>

namespace stipple::page {

// The files of page/, embedded by cmake/EmbedFiles.cmake.

extern const std::string_view kHtml;
extern const std::string_view kStyle;
extern const std::string_view kView;  ///< HTML with the marks of kHtml
extern const std::string_view kViewProgram;
extern const std::string_view kProgram;             ///< all .js files, one after the other
extern const std::string_view kExploration;         ///< HTML of the page of `stipple explore`
extern const std::string_view kExplorationStyle;    ///< what its style has beside kStyle
extern const std::string_view kExplorationProgram;  ///< all .js files of this page
extern const std::string_view kChartsLicence;       ///< as a comment of HTML
extern const std::string_view kCharts;  ///< Chart.js, minified; empty if the build has not found it

}  // namespace stipple::page
