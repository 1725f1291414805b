#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "report/packed_plane.h"

namespace stipple {

/// `data` as the content of a script element: no "<", ">" or "&" of a file's text can end the
/// element or begin another one. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& data);

/// `text` as the content of an element or of an attribute in double quotes.
[[nodiscard]] std::string html_text(std::string_view text);

/// The page: one HTML file that needs nothing else, with its style, its program, the library of
/// charts, `data` as JSON and the planes.
[[nodiscard]] std::string report_page(const std::string& title, const nlohmann::ordered_json& data,
                                      const std::vector<PackedPlane>& planes);

}  // namespace stipple
