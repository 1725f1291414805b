#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace stipple {

/// What is known; null if there is no value, or the text is empty.
template <typename Value>
[[nodiscard]] nlohmann::ordered_json or_null(const std::optional<Value>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}
[[nodiscard]] inline nlohmann::ordered_json or_null(const std::string& text) {
    return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(text);
}

/// A JSON object of the figures that `visit(add)` adds, in their order: the functions
/// `visit_..._figures` of the libraries. std::nullopt becomes null, nested figures an object, a
/// list an array of objects.
template <typename Visit>
[[nodiscard]] nlohmann::ordered_json json_of(const Visit& visit) {
    auto json = nlohmann::ordered_json::object();  // [] of null aborts where memory runs out
    visit([&](const char* name, const auto& value) {
        if constexpr (requires { value.items; }) {
            auto& list = json[name] = nlohmann::ordered_json::array();
            for (const auto& item : value.items)
                list.push_back(json_of([&](const auto& add) { value.visit(item, add); }));
        } else if constexpr (requires { value.visit; }) {
            json[name] = json_of(value.visit);
        } else if constexpr (requires { value.has_value(); }) {
            json[name] = or_null(value);
        } else {
            json[name] = value;
        }
    });
    return json;
}

}  // namespace stipple
