#include "study/report/report_page.h"

#include "study/report/page_parts.h"

namespace stipple {

std::string exploration_page(const std::string& title, const std::string& data) {
    return filled_page(
        page::kExploration,
        {{"@CONNECT@", "'none'"},
         {"@TITLE@", html_text(title)},
         {"@STYLE@", std::string(page::kStyle) + std::string(page::kExplorationStyle)},
         {"@SUBTITLE@", "Sensors, schedules and decoders: what they cost and how good they are"},
         {"@LICENCE@", std::string(page::kChartsLicence)},
         {"@CHARTS@", std::string(page::kCharts)},
         {"@DATA@", script_text(data)},
         {"@PLANES@", ""},
         {"@PROGRAM@", std::string(page::kExplorationProgram)}});
}

}  // namespace stipple
