#pragma once

#include <string_view>

#include "core/config.h"

namespace stipple {

/// Sets `value` to that of `key`, if the file or an override has it. \throws InputError if it is
/// outside `min`..`max`.
inline void read_number(Config& config, std::string_view key, double min, double max,
                        float& value) {
    value = static_cast<float>(config.number(key, static_cast<double>(value), min, max));
}

inline void read_integer(Config& config, std::string_view key, int min, int max, int& value) {
    value = static_cast<int>(config.integer(key, value, min, max));
}

}  // namespace stipple
