#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/named_value.h"

namespace stipple {

/// Behaviour of a chip if the readout of a slot takes longer than the slot.
enum class OverrunPolicy : std::uint8_t {
    kStretch,  ///< the slot lasts as long as its readout; its light stays that of one slot
    kDrop      ///< rows that do not fit are reset without readout
};

inline constexpr auto kOverrunPolicies = std::to_array<NamedValue<OverrunPolicy>>(
    {{"stretch", OverrunPolicy::kStretch}, {"drop", OverrunPolicy::kDrop}});

[[nodiscard]] constexpr std::string_view name_of(OverrunPolicy policy) {
    return name_in(kOverrunPolicies, policy);
}

}  // namespace stipple
