#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/message.h"

namespace stipple {

/// Closed interval of the accepted values of a number; of an integer within +-2^53.
struct KeyRange {
    double min = 0;
    double max = 0;
};

/// Description of a key by the code that reads it. Strings and choices must outlive the call.
struct ConfigKey {
    std::string_view name;                           ///< with sections: "timing.clock_hz"
    KeyRange range = {};                             ///< of a number, or of each in a list
    std::string_view unit = {};                      ///< empty: none
    std::string_view text = {};                      ///< definition, one line
    std::span<const std::string_view> choices = {};  ///< accepted texts; empty: any
};

/// A key that was read, for `stipple list keys`.
struct KnownKey {
    std::string name;
    std::string fallback;  ///< default as text; empty: none
    std::string range;     ///< "min..max" of numbers and lists of numbers, "a, b" of choices
    std::string unit;
    std::string text;

    bool operator==(const KnownKey&) const = default;
};

/// Values of a TOML file and of "key=value" overrides, which replace those of the file. A reader
/// asks for each key that it knows; `reject_unknown_keys` then reports all others, so a misspelt
/// key is always an error.
class Config {
  public:
    /// Reads `file` and applies `overrides` in their order ("read_noise_e=5", "adc.bit_depth=10").
    /// A value has TOML syntax; a bare word is a string. Messages name an override by the Parameter
    /// "SECTION.KEY", with `section` such as "sensor".
    /// \throws InputError naming file, line and column, or the override.
    Config(const std::filesystem::path& file, const std::vector<std::string>& overrides,
           std::string_view section = {});
    /// Overrides alone, without a file. \throws InputError naming the override.
    explicit Config(const std::vector<std::string>& overrides, std::string_view section = {});
    ~Config();
    Config(Config&&) noexcept;
    Config& operator=(Config&&) noexcept;

    /// The value of `key`, or `fallback` if absent, which may lie outside the range and is returned
    /// as it is. \throws InputError naming file, line and key if the type is wrong or the value
    /// lies outside its range.
    [[nodiscard]] double number(const ConfigKey& key, double fallback);
    [[nodiscard]] std::int64_t integer(const ConfigKey& key, std::int64_t fallback);
    [[nodiscard]] bool boolean(const ConfigKey& key, bool fallback);
    [[nodiscard]] std::string text(const ConfigKey& key, std::string_view fallback);
    /// The index in `key.choices`. \throws InputError listing them.
    [[nodiscard]] std::size_t choice(const ConfigKey& key, std::size_t fallback);
    /// One integer or a list of integers.
    [[nodiscard]] std::vector<int> integers(const ConfigKey& key, const std::vector<int>& fallback);
    /// One number or a list of numbers.
    [[nodiscard]] std::vector<double> numbers(const ConfigKey& key,
                                              const std::vector<double>& fallback);
    /// A list of texts; empty if absent.
    [[nodiscard]] std::vector<std::string> texts(const ConfigKey& key);
    /// True if the key has a value. Does not make it known.
    [[nodiscard]] bool contains(std::string_view key) const;

    /// True if the file has no keys.
    [[nodiscard]] bool file_is_empty() const;

    /// All keys with their values as text, in the order of the file, then of the overrides. For
    /// settings whose names only a device knows. \throws InputError for a list or a date.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> entries() const;

    /// The values of `section` (empty: all), as lines "key = value" of TOML, sorted by key, without
    /// the name of the section.
    [[nodiscard]] std::string as_toml(std::string_view section) const;

    /// \throws InputError for a key with a value that no reader asked for, with the nearest known
    /// key as a suggestion.
    void reject_unknown_keys() const;

    /// The keys that readers asked for, sorted by name.
    [[nodiscard]] std::vector<KnownKey> known_keys() const;

    /// Place of a key for messages: "file:line: key", or the Parameter "section.key".
    [[nodiscard]] Message where(std::string_view key) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Kinds of configuration files.
enum class ConfigKind : std::uint8_t { kSensors, kSchedules, kSpaces, kRigs, kModels };

/// The folder of a kind: "sensors", "schedules", "spaces", "rigs", "models".
[[nodiscard]] std::string_view folder_of(ConfigKind kind);

/// Finds `name` as a file, or as `<config folder>/<folder of the kind>/<name>.toml`; a model as
/// `<name>.safetensors`.
/// \throws InputError naming the one that was probably meant, or all there are.
[[nodiscard]] std::filesystem::path find_config(ConfigKind kind, std::string_view name);

/// All names of a kind, sorted.
[[nodiscard]] std::vector<std::string> config_names(ConfigKind kind);

/// \throws InputError that names the folders searched if there is none of this kind.
void require_configs(ConfigKind kind);

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

/// Max parts of a key or of a table name, as in "a.b.c".
inline constexpr std::size_t kMaxKeyParts = 32;

/// The line (from 1) of the first key in TOML text with more parts than that; 0 if there is none.
/// Parser and destructors recurse once per part, so a long key would overflow the stack.
[[nodiscard]] std::size_t line_of_long_key(std::string_view toml);

}  // namespace stipple
