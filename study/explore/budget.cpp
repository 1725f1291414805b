#include "study/explore/ranking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/text.h"

namespace stipple {

std::optional<Budget> parse_budget(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::string_view units = "smh";
    const std::size_t unit = units.find(text.back());
    const bool is_time = unit != std::string_view::npos;
    const auto amount = parsed_number<double>(is_time ? text.substr(0, text.size() - 1) : text);
    if (!amount || !std::isfinite(*amount) || !(*amount > 0)) return std::nullopt;
    if (!is_time) return Budget{*amount, Budget::Unit::kClips};
    constexpr double kSecondsOfUnit[] = {1, 60, 3600};
    return Budget{*amount * kSecondsOfUnit[unit], Budget::Unit::kSeconds};
}

std::vector<int> rungs_of(int slots) {
    constexpr int kMaxRungs = 3;
    std::vector<int> rungs{slots};
    for (int shorter = slots / 2; rungs.size() < kMaxRungs && shorter >= kMinRungSlots;
         shorter /= 2)
        rungs.push_back(shorter);
    std::ranges::reverse(rungs);
    return rungs;
}

std::size_t affordable(std::span<const double> costs, std::size_t most, double share, double rest) {
    std::size_t count = 0;
    for (double sum = 0; count < std::min(most, costs.size()); ++count) {
        sum += costs[count];
        if (sum > (count == 0 ? rest : share)) break;
    }
    return count;
}

}  // namespace stipple
