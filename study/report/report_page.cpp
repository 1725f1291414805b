#include "study/report/report_page.h"

#include <cstddef>
#include <nlohmann/json.hpp>

#include "io/tone_map.h"
#include "study/report/page_parts.h"
#include "study/report/run_report.h"

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
    return script_text(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

// In JSON these characters are in texts only.
std::string script_text(std::string json) {
    replace_all(json, "<", "\\u003c");
    replace_all(json, ">", "\\u003e");
    replace_all(json, "&", "\\u0026");
    return json;
}

std::string html_text(std::string_view text) {
    std::string escaped(text);
    replace_all(escaped, "&", "&amp;");
    replace_all(escaped, "<", "&lt;");
    replace_all(escaped, ">", "&gt;");
    replace_all(escaped, "\"", "&quot;");
    return escaped;
}

std::string filled_page(std::string_view html, const std::vector<PagePart>& parts) {
    std::string text;
    std::size_t from = 0;
    for (const auto& [mark, part] : parts) {
        const std::size_t at = html.find(mark, from);
        text += html.substr(from, at - from);
        text += part;
        from = at + mark.size();
    }
    return text += html.substr(from);
}

namespace {

/// The parts of a page that do not depend on its data.
struct PageKind {
    std::string_view html;
    std::string_view program;
    const char* connect;  ///< what it may ask, in a content security policy
};

std::string page_of(const PageKind& kind, const std::string& title,
                    const nlohmann::ordered_json& data, const std::string& planes) {
    return filled_page(kind.html, {{"@CONNECT@", kind.connect},
                                   {"@TITLE@", html_text(title)},
                                   {"@STYLE@", std::string(page::kStyle)},
                                   {"@SUBTITLE@", ""},  // of the data
                                   {"@LICENCE@", std::string(page::kChartsLicence)},
                                   {"@CHARTS@", std::string(page::kCharts)},
                                   {"@DATA@", script_json(data)},
                                   {"@PLANES@", planes},
                                   {"@PROGRAM@", std::string(kind.program)}});
}

}  // namespace

std::string report_page(const std::string& title, const nlohmann::ordered_json& data,
                        const std::vector<PackedPlane>& planes) {
    return page_of({page::kHtml, page::kProgram, "'none'"}, title, data, planes_text(planes));
}

std::string view_page(const std::string& title, const nlohmann::ordered_json& data) {
    return page_of({page::kView, page::kViewProgram, "'self'"}, title, data, "");
}

nlohmann::ordered_json pictures_json(FrameShape frame, const PixelArea& area) {
    return {{"area",
             {{"rows", area.rows},
              {"cols", area.cols},
              {"planes", frame.planes},
              {"first_row", area.first_row},
              {"first_col", area.first_col}}},
            {"frame", {{"rows", frame.rows}, {"cols", frame.cols}}},
            {"light_code", {{"darkest", kDarkestCodedLight}, {"codes_per_stop", kCodesPerStop}}},
            {"white_light", kWhiteLight}};
}

std::string chart_warning() {
    if (!page::kCharts.empty()) return {};
    return "the page has no charts: this build has not found Chart.js; install the package "
           "libjs-chart.js, and configure and build again";
}

}  // namespace stipple
