#include "study/report/camera_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/input_file.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// Figures that are not finite are null.
bool is_figures(const ordered_json& figures) {
    return figures.is_object() && std::ranges::all_of(figures, [](const ordered_json& figure) {
               return figure.is_number() || figure.is_null();
           });
}

bool is_point(const ordered_json& point) {
    return point.is_array() && point.size() == 3 &&
           std::ranges::all_of(point,
                               [](const ordered_json& number) { return number.is_number(); });
}

bool is_camera(const ordered_json& json) {
    if (!json.is_object() || !json.contains("measured") || !json.contains("photon_transfer") ||
        !json.contains("saturation_point"))
        return false;
    const ordered_json& points = json["photon_transfer"];
    const ordered_json& saturation = json["saturation_point"];
    return is_figures(json["measured"]) &&
           (!json.contains("configured") || is_figures(json["configured"])) && points.is_array() &&
           std::ranges::all_of(points, is_point) && saturation.is_number_unsigned() &&
           saturation.get<std::size_t>() < points.size();
}

}  // namespace

std::string read_camera_file(const std::string& file) {
    const auto bytes = read_file(file);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const ordered_json json = ordered_json::parse(text, text + bytes.size(), nullptr, false);
    if (!is_camera(json))
        throw InputError(file, "is not a result that \"stipple characterize\" wrote as JSON");
    ordered_json camera;
    for (const char* key : {"measured", "configured", "photon_transfer", "saturation_point"})
        if (json.contains(key)) camera[key] = json[key];
    return camera.dump();
}

}  // namespace stipple
