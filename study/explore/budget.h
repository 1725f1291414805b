#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// What decoding may cost in all.
struct Budget {
    enum class Unit : std::uint8_t {
        kSeconds,  ///< measured time of decoding
        kClips,    ///< decoded clips, a shorter one as its fraction
    };
    double amount = 0;
    Unit unit = Unit::kClips;
};

/// "90s", "10m", "2h" or a number of clips; nothing for other texts and for 0 or less.
[[nodiscard]] std::optional<Budget> parse_budget(const std::string& text);

/// Slots of the rungs of a clip: the whole clip, before that a half, before that a quarter; none of
/// fewer than kMinRungSlots slots.
[[nodiscard]] std::vector<int> rungs_of(int slots);
inline constexpr int kMinRungSlots = 12;

/// How many of the points, best ones first, go on: at most `most`; as many as the `share` of the
/// rung pays for at the expected `costs`, but one if `rest` pays for it.
[[nodiscard]] std::size_t affordable(std::span<const double> costs, std::size_t most, double share,
                                     double rest);

}  // namespace stipple
