#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/config.h"

namespace stipple {

/// Reads the keys of a section into variables; what a variable holds before is the key's default.
class KeyReader {
  public:
    /// The names of keys begin with `prefix`, "timing.".
    explicit KeyReader(Config& config, std::string prefix = {})
        : config_(config), prefix_(std::move(prefix)) {}

    /// An enumerator is the index of its name in `key.choices`. \throws InputError as Config.
    template <typename Value>
    void operator()(const ConfigKey& key, Value& value) const {
        const std::string name = prefix_ + std::string(key.name);
        ConfigKey whole = key;
        whole.name = name;
        if constexpr (std::is_enum_v<Value>)
            value = static_cast<Value>(config_.choice(whole, static_cast<std::size_t>(value)));
        else if constexpr (std::is_same_v<Value, bool>)
            value = config_.boolean(whole, value);
        else if constexpr (std::is_integral_v<Value>)
            value = static_cast<Value>(config_.integer(whole, value));
        else if constexpr (std::is_floating_point_v<Value>)
            value = static_cast<Value>(config_.number(whole, static_cast<double>(value)));
        else if constexpr (std::is_same_v<Value, std::string>)
            value = config_.text(whole, value);
        else if constexpr (std::is_same_v<Value, std::vector<int>>)
            value = config_.integers(whole, value);
        else
            value = config_.numbers(whole, value);
    }

  private:
    Config& config_;
    std::string prefix_;
};

}  // namespace stipple
