#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stipple {

/// Closed interval of accepted numbers; of integers within 2^53.
struct KeyRange {
    double min = 0;
    double max = 0;
};

/// A key as its reader describes it. Strings and choices must last as long as the call.
struct ConfigKey {
    std::string_view name;  ///< dotted
    KeyRange range = {};    ///< of a number, of each number of a list
    std::string_view unit = {};
    std::string_view text = {};                      ///< what it is, one line
    std::span<const std::string_view> choices = {};  ///< of a name
};

/// A key that was asked for, as `key=value` takes it.
struct KnownKey {
    std::string name;
    std::string fallback;  ///< empty: it has none
    std::string range;     ///< "min..max" of numbers and lists of numbers, "a, b" of choices
    std::string unit;
    std::string text;

    bool operator==(const KnownKey&) const = default;
};

/// Settings from a TOML file with `key=value` overrides laid over it. A module asks for each key
/// it knows by its dotted name; what nobody asked for is an error, so a misspelt key never passes.
class Config {
  public:
    /// Reads `file` and applies `overrides` ("read_noise_e=5", "adc.bit_depth=10"; values in TOML
    /// syntax, a bare word is a string). Messages name an override as the command line has it, with
    /// the `section` before it ("sensor").
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
    /// Whether the key is given; asking does not make it known.
    [[nodiscard]] bool contains(std::string_view key) const;

    /// Whether the file has no keys.
    [[nodiscard]] bool file_is_empty() const;

    /// All that was given, as text, in the order in which it was: the file, then the overrides.
    /// For settings whose names only a device knows. \throws InputError for a list or a date.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> entries() const;

    /// What was given in `section` (empty: everything), without its name: lines of TOML, by key.
    [[nodiscard]] std::string as_toml(std::string_view section) const;

    /// \throws InputError for a key that was given but never asked for, with the nearest known
    /// key as a suggestion.
    void reject_unknown_keys() const;

    /// What has been asked for, by key.
    [[nodiscard]] std::vector<KnownKey> known_keys() const;

    /// "file:line: key" (or "--set key") for messages.
    [[nodiscard]] std::string where(std::string_view key) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What a configuration file describes.
enum class ConfigKind : std::uint8_t { kSensors, kSchedules };

/// The folder of a kind: "sensors", "schedules".
[[nodiscard]] std::string_view folder_of(ConfigKind kind);

/// Finds `name` as a file, or as `<config folder>/<folder of the kind>/<name>.toml`.
/// \throws InputError naming the one that was probably meant, or all there are.
[[nodiscard]] std::filesystem::path find_config(ConfigKind kind, std::string_view name);

/// All names of a kind, sorted.
[[nodiscard]] std::vector<std::string> config_names(ConfigKind kind);

}  // namespace stipple
