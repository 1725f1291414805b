#include "report/report_page.h"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/page_parts.h"
#include "report/run_report.h"

namespace stipple {
namespace {

void replace_all(std::string& text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

std::string planes_text(const std::vector<PackedPlane>& planes) {
    std::string text;
    for (const PackedPlane& plane : planes)
        text += "<script type=\"text/plain\" id=\"" + html_text(plane.id) + "\">" + plane.text +
                "</script>\n";
    return text;
}

}  // namespace

std::string script_json(const nlohmann::ordered_json& data) {
    using nlohmann::ordered_json;
    std::string text = data.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    replace_all(text, "<", "\\u003c");
    replace_all(text, ">", "\\u003e");
    replace_all(text, "&", "\\u0026");
    return text;
}

std::string html_text(std::string_view text) {
    std::string escaped(text);
    replace_all(escaped, "&", "&amp;");
    replace_all(escaped, "<", "&lt;");
    replace_all(escaped, ">", "&gt;");
    replace_all(escaped, "\"", "&quot;");
    return escaped;
}

std::string report_page(const std::string& title, const nlohmann::ordered_json& data,
                        const std::vector<PackedPlane>& planes) {
    const std::array<std::pair<std::string_view, std::string>, 6> parts{
        {{"@TITLE@", html_text(title)},
         {"@STYLE@", std::string(page::kStyle)},
         {"@CHARTS@", std::string(page::kCharts)},
         {"@DATA@", script_json(data)},
         {"@PLANES@", planes_text(planes)},
         {"@PROGRAM@", std::string(page::kProgram)}}};
    std::string text;
    std::size_t from = 0;
    for (const auto& [mark, part] :
         parts) {  // in their order, so that no part is searched for marks
        const std::size_t at = page::kHtml.find(mark, from);
        text += page::kHtml.substr(from, at - from);
        text += part;
        from = at + mark.size();
    }
    return text += page::kHtml.substr(from);
}

std::string chart_warning() {
    if (!page::kCharts.empty()) return {};
    return "the page has no charts: this build has not found Chart.js; install the package "
           "libjs-chart.js, and configure and build again";
}

}  // namespace stipple
