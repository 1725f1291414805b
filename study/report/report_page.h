#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "study/report/packed_plane.h"

namespace stipple {

/// `data` as the content of a script element: no "<", ">" or "&" of a file's text can end the
/// element or begin another one. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& data);

/// JSON as the content of a script element, likewise.
[[nodiscard]] std::string script_text(std::string json);

/// `text` as the content of an element or of an attribute in double quotes.
[[nodiscard]] std::string html_text(std::string_view text);

/// A mark of a page, and what takes its place.
using PagePart = std::pair<std::string_view, std::string>;

/// `html` with its marks replaced. Precondition: `parts` are in the order of their marks, so that
/// no part is searched for marks.
[[nodiscard]] std::string filled_page(std::string_view html, const std::vector<PagePart>& parts);

/// The page: one HTML file that needs nothing else, with its style, its program, the library of
/// charts, `data` as JSON and the planes.
[[nodiscard]] std::string report_page(const std::string& title, const nlohmann::ordered_json& data,
                                      const std::vector<PackedPlane>& planes);

}  // namespace stipple
