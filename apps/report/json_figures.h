#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace stipple {

/// A JSON object of the figures that `visit(add)` adds, in their order: the functions
/// `visit_..._figures` of the libraries. std::nullopt becomes null.
template <typename Visit>
[[nodiscard]] nlohmann::ordered_json json_of(const Visit& visit) {
    auto json = nlohmann::ordered_json::object();  // [] of null aborts where memory runs out
    visit([&](const char* name, const auto& value) {
        if constexpr (requires { value.has_value(); })
            json[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
        else
            json[name] = value;
    });
    return json;
}

}  // namespace stipple
