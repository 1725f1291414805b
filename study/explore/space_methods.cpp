#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "study/explore/space.h"

namespace stipple {
namespace {

constexpr const char* kBest = "best";  // the method

std::string& value_of(SpaceSystem& system, std::string_view name) {
    return std::ranges::find(system.values, name, &std::pair<std::string, std::string>::first)
        ->second;
}

bool is_best_of_one(const SpaceSystem& system) {
    return std::ranges::find(system.values, std::pair<std::string, std::string>("method", kBest)) !=
               system.values.end() &&
           std::ranges::none_of(system.values,
                                [](const auto& value) { return value.first == "rig"; });
}

/// The name with `method` in place of the word "best", or behind it if it has none.
std::string copy_name(const std::string& name, const std::string& method) {
    const std::string padded = " " + name + " ";
    const std::size_t place = padded.find(fmt::format(" {} ", kBest));
    if (place == std::string::npos) return fmt::format("{} {}", name, method);
    return std::string(name).replace(place, std::string_view(kBest).size(), method);
}

}  // namespace

void Space::set_methods(const std::vector<std::string>& methods) {
    if (systems.empty()) {
        axes[axis("method")].values = methods;
        return;
    }
    std::vector<std::string>& names = axes[axis("system")].values;
    for (const SpaceSystem& system : std::vector(systems)) {
        if (!is_best_of_one(system)) continue;
        for (const std::string& method : methods) {
            SpaceSystem copy{copy_name(system.name, method), system.values, system.name};
            if (std::ranges::find(names, copy.name) != names.end()) continue;
            std::erase_if(copy.values,
                          [](const auto& value) { return value.first.starts_with("decoder."); });
            value_of(copy, "method") = method;
            names.push_back(copy.name);
            systems.push_back(std::move(copy));
        }
    }
}

const OwnDecoder* Space::own_decoder(const SpacePoint& point) const {
    const auto found = std::ranges::find(decoders, value(point, "method"), &OwnDecoder::name);
    return found == decoders.end() ? nullptr : &*found;
}

}  // namespace stipple
