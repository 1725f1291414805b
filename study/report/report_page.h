#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "study/report/report_window.h"

namespace stipple {

/// The most bytes of the page that a plane takes beside its text.
inline constexpr std::size_t kPlaneTagBytes = 64;

/// A block of data in the page: base64 (packed_plane) under a name.
struct PackedPlane {
    std::string id;
    std::string text;
};

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

/// The page of `stipple view`: the same parts, but it asks its server for the planes (view/).
[[nodiscard]] std::string view_page(const std::string& title, const nlohmann::ordered_json& data);

/// The page of `stipple explore`: one HTML file that needs nothing else, with its style, its
/// program and the library of charts. `data`: JSON as page/exploration/data.js reads it.
[[nodiscard]] std::string exploration_page(const std::string& title, const std::string& data);

/// Code 1 stands for this light; less is code 0, no light.
inline constexpr double kDarkestCodedLight = 1.0 / 16384;
/// Neighbouring codes differ by 2^(1/128), 0.54 %.
inline constexpr int kCodesPerStop = 128;

/// Light on a logarithmic scale: 1 + round(128 log2(light / kDarkestCodedLight)), 0 for less light
/// and for NaN. The light of a code is within 0.27 % of what was coded.
[[nodiscard]] std::uint16_t light_code(float light) noexcept;
/// The same of each value.
[[nodiscard]] std::vector<std::uint16_t> light_codes(std::span<const float> light);
/// The light of a code.
[[nodiscard]] double light_of_code(std::uint16_t code) noexcept;

/// What a page needs to know of its pictures: `area`, `frame`, `light_code` and `white_light`.
[[nodiscard]] nlohmann::ordered_json pictures_json(FrameShape frame, const PixelArea& area);

/// `values` as text for the page: the difference of each value from that `step` before it (modulo
/// 2^16, the first ones from 0) with its sign in the lowest bit (2 d, or -2 d - 1 below 0), all low
/// bytes and then all high bytes, deflated (zlib), in base64. page/planes.js reads it. `step` > 1:
/// values of so many colours take turns.
[[nodiscard]] std::string packed_plane(std::span<const std::uint16_t> values, std::size_t step = 1);

}  // namespace stipple
