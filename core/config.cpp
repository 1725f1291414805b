#include "core/config.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <compare>
#include <list>
#include <map>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"

namespace stipple {
namespace {

/// Where a value was given. The order is that in which values apply.
struct Place {
    enum class Source : std::uint8_t { kFile, kOverride };
    Source source = Source::kFile;
    std::size_t number = 0;  ///< line of the file, or number of the override

    auto operator<=>(const Place&) const = default;
};

struct Entry {
    const toml::node* value = nullptr;
    Place place;
    bool known = false;
};
using Entries = std::map<std::string, Entry, std::less<>>;

/// Characters of a key with its sections. Each value stores all of them.
constexpr std::size_t kMaxKeyLength = 256;

/// Adds all values of `table` under their dotted names. Empty tables count as values, so that a
/// misspelt section is noticed.
void flatten(const toml::table& table, const std::string& prefix, const std::string& file,
             Entries& entries) {
    for (const auto& [key, value] : table) {
        const std::string name = fmt::format("{}{}", prefix, key.str());
        if (name.size() > kMaxKeyLength)
            throw InputError(fmt::format("{}:{}", file, key.source().begin.line),
                             fmt::format("a key is longer than {} characters, with those of its "
                                         "sections",
                                         kMaxKeyLength));
        const auto* inner = value.as_table();
        if (inner != nullptr && !inner->empty()) {
            flatten(*inner, fmt::format("{}.", name), file, entries);
            continue;
        }
        const Place place{Place::Source::kFile, key.source().begin.line};
        if (!entries.try_emplace(name, Entry{&value, place}).second)
            throw InputError(fmt::format("{}:{}: {}", file, place.number, name), "is given twice");
    }
}

/// "value = <text>", or the text as a string if it is not TOML.
toml::table parse_value(std::string_view text) {
    try {
        if (line_of_long_key(text) == 0) {
            toml::table table = toml::parse(fmt::format("value = {}", text));
            if (table.size() == 1) return table;
        }
    } catch (const toml::parse_error&) {
        // A bare word.
    }
    toml::table table;
    table.insert("value", std::string(text));
    return table;
}

std::string_view type_name(const toml::node& value) {
    switch (value.type()) {
        case toml::node_type::table:
            return "a section";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "text";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        default:
            return "a date or time";
    }
}

template <typename Value>
std::string range_text(Value min, Value max) {
    return fmt::format("{}..{}", min, max);
}

template <typename Value>
std::string list_text(const std::vector<Value>& values) {
    std::vector<std::string> items;
    items.reserve(values.size());
    for (const Value value : values) items.push_back(fmt::format("{}", value));
    return items.size() == 1 ? items.front() : fmt::format("[{}]", joined(items));
}

}  // namespace

struct Config::Impl {
    std::string file;
    std::string section;            ///< of the overrides, "sensor."
    std::list<toml::table> tables;  ///< what the entries point into
    Entries entries;
    std::map<std::string, KnownKey, std::less<>> asked;

    void set(const std::string& assignment);
    /// The value of a key, or null; from now on the key is known.
    const toml::node* find(const ConfigKey& key, std::string fallback, std::string range = {});
    /// Takes each item of a list, or the only one, with `take`; false if there is none.
    template <typename Take>
    bool each(const ConfigKey& key, std::string fallback, std::string range, const Take& take) {
        const toml::node* node = find(key, std::move(fallback), std::move(range));
        if (node == nullptr) return false;
        if (const toml::array* list = node->as_array())
            for (const toml::node& item : *list) take(item);
        else
            take(*node);
        return true;
    }
    [[nodiscard]] Message where(std::string_view key) const;

    template <typename Value>
    void check_range(std::string_view key, Value value, Value min, Value max) const {
        if (value >= min && value <= max) return;  // false for NaN
        throw InputError(where(key), fmt::format("{} is outside {}", value, range_text(min, max)));
    }
    [[noreturn]] void fail_type(std::string_view key, const toml::node& value,
                                std::string_view wanted) const {
        throw InputError(where(key), fmt::format("needs {}, but is {}", wanted, type_name(value)));
    }
};

void Config::Impl::set(const std::string& assignment) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size())
        throw InputError(Parameter{section + assignment}, "write key=value");
    const std::string key = assignment.substr(0, equals);
    tables.push_back(parse_value(std::string_view(assignment).substr(equals + 1)));
    entries[key] = Entry{tables.back().get("value"), {Place::Source::kOverride, tables.size()}};
}

const toml::node* Config::Impl::find(const ConfigKey& key, std::string fallback,
                                     std::string range) {
    asked.try_emplace(std::string(key.name),
                      KnownKey{std::string(key.name), std::move(fallback), std::move(range),
                               std::string(key.unit), std::string(key.text)});
    const auto found = entries.find(key.name);
    if (found == entries.end()) return nullptr;
    found->second.known = true;
    return found->second.value;
}

Message Config::Impl::where(std::string_view key) const {
    const auto found = entries.find(key);
    if (found == entries.end())
        return file.empty() ? std::string(key) : fmt::format("{}: {}", file, key);
    const Place place = found->second.place;
    if (place.source == Place::Source::kOverride) return Parameter{section + std::string(key)};
    return fmt::format("{}:{}: {}", file, place.number, key);
}

Config::Config(const std::filesystem::path& file, const std::vector<std::string>& overrides,
               std::string_view section)
    : impl_(std::make_unique<Impl>()) {
    impl_->file = file.string();
    if (!section.empty()) impl_->section = fmt::format("{}.", section);
    const auto bytes = read_file(file);
    const std::string text(bytes.begin(), bytes.end());
    if (const std::size_t line = line_of_long_key(text); line != 0)
        throw InputError(fmt::format("{}:{}", impl_->file, line),
                         fmt::format("a key has more than {} parts", kMaxKeyParts));
    try {
        impl_->tables.push_back(toml::parse(text, impl_->file));
    } catch (const toml::parse_error& e) {
        throw InputError(
            fmt::format("{}:{}:{}", impl_->file, e.source().begin.line, e.source().begin.column),
            e.description());
    }
    flatten(impl_->tables.back(), "", impl_->file, impl_->entries);
    for (const std::string& assignment : overrides) impl_->set(assignment);
}

Config::Config(const std::vector<std::string>& overrides, std::string_view section)
    : impl_(std::make_unique<Impl>()) {
    if (!section.empty()) impl_->section = fmt::format("{}.", section);
    for (const std::string& assignment : overrides) impl_->set(assignment);
}

bool Config::file_is_empty() const {
    return impl_->tables.empty() || impl_->tables.front().empty();
}

Config::~Config() = default;
Config::Config(Config&&) noexcept = default;
Config& Config::operator=(Config&&) noexcept = default;

double Config::number(const ConfigKey& key, double fallback) {
    const auto [min, max] = key.range;
    const bool has_default = fallback >= min && fallback <= max;
    const toml::node* node =
        impl_->find(key, has_default ? fmt::format("{:.7g}", fallback) : "", range_text(min, max));
    if (node == nullptr) return fallback;
    if (!node->is_number()) impl_->fail_type(key.name, *node, "a number");
    const double value = *node->value<double>();
    impl_->check_range(key.name, value, min, max);
    return value;
}

std::int64_t Config::integer(const ConfigKey& key, std::int64_t fallback) {
    const auto min = static_cast<std::int64_t>(key.range.min);
    const auto max = static_cast<std::int64_t>(key.range.max);
    const bool has_default = fallback >= min && fallback <= max;
    const toml::node* node =
        impl_->find(key, has_default ? fmt::format("{}", fallback) : "", range_text(min, max));
    if (node == nullptr) return fallback;
    if (!node->is_integer()) impl_->fail_type(key.name, *node, "an integer");
    const std::int64_t value = *node->value<std::int64_t>();
    impl_->check_range(key.name, value, min, max);
    return value;
}

bool Config::boolean(const ConfigKey& key, bool fallback) {
    const toml::node* node = impl_->find(key, fallback ? "true" : "false");
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) impl_->fail_type(key.name, *node, "true or false");
    return *node->value<bool>();
}

std::string Config::text(const ConfigKey& key, std::string_view fallback) {
    const toml::node* node =
        impl_->find(key, fallback.empty() ? "\"\"" : std::string(fallback), joined(key.choices));
    if (node == nullptr) return std::string(fallback);
    if (!node->is_string()) impl_->fail_type(key.name, *node, "text");
    return *node->value<std::string>();
}

std::size_t Config::choice(const ConfigKey& key, std::size_t fallback) {
    const std::string value = text(key, key.choices[fallback]);
    const auto found = std::ranges::find(key.choices, value);
    if (found == key.choices.end())
        throw InputError(where(key.name),
                         fmt::format("\"{}\" is not one of {}", value, joined(key.choices)));
    return static_cast<std::size_t>(found - key.choices.begin());
}

std::vector<int> Config::integers(const ConfigKey& key, const std::vector<int>& fallback) {
    const auto min = static_cast<std::int64_t>(key.range.min);
    const auto max = static_cast<std::int64_t>(key.range.max);
    std::vector<int> values;
    const bool given =
        impl_->each(key, list_text(fallback), range_text(min, max), [&](const toml::node& item) {
            if (!item.is_integer()) impl_->fail_type(key.name, item, "a list of integers");
            const std::int64_t value = *item.value<std::int64_t>();
            impl_->check_range(key.name, value, min, max);
            values.push_back(static_cast<int>(value));
        });
    return given ? values : fallback;
}

std::vector<double> Config::numbers(const ConfigKey& key, const std::vector<double>& fallback) {
    const double min = key.range.min, max = key.range.max;
    std::vector<double> values;
    const bool given =
        impl_->each(key, list_text(fallback), range_text(min, max), [&](const toml::node& item) {
            if (!item.is_number())
                impl_->fail_type(key.name, item, "a number or a list of numbers");
            values.push_back(*item.value<double>());
            impl_->check_range(key.name, values.back(), min, max);
        });
    return given ? values : fallback;
}

std::vector<std::string> Config::texts(const ConfigKey& key) {
    const toml::node* node = impl_->find(key, "");
    if (node == nullptr) return {};
    const toml::array* list = node->as_array();
    if (list == nullptr) impl_->fail_type(key.name, *node, "a list of texts");
    std::vector<std::string> values;
    values.reserve(list->size());
    for (const toml::node& item : *list) {
        if (!item.is_string()) impl_->fail_type(key.name, item, "a list of texts");
        values.push_back(*item.value<std::string>());
    }
    return values;
}

bool Config::contains(std::string_view key) const {
    return impl_->entries.find(key) != impl_->entries.end();
}

std::vector<std::pair<std::string, std::string>> Config::entries() const {
    std::vector<std::pair<Place, std::pair<std::string, std::string>>> found;
    for (const auto& [key, entry] : impl_->entries) {
        const auto* text = entry.value->as_string();
        if (text == nullptr && !entry.value->is_number() && !entry.value->is_boolean())
            impl_->fail_type(key, *entry.value, "text, a number, true or false");
        std::ostringstream out;
        out.exceptions(std::ios::badbit);  // else it ends early where there is no memory
        if (text != nullptr)
            out << text->get();
        else
            entry.value->visit([&](const auto& value) { out << value; });
        found.emplace_back(entry.place, std::pair(key, out.str()));
    }
    std::sort(found.begin(), found.end());
    std::vector<std::pair<std::string, std::string>> entries;
    entries.reserve(found.size());
    for (auto& [place, entry] : found) entries.push_back(std::move(entry));
    return entries;
}

std::string Config::as_toml(std::string_view section) const {
    const std::string prefix = section.empty() ? "" : fmt::format("{}.", section);
    std::ostringstream out;
    out.exceptions(std::ios::badbit);
    for (const auto& [key, entry] : impl_->entries) {
        if (!key.starts_with(prefix)) continue;
        out << key.substr(prefix.size()) << " = ";
        entry.value->visit([&](const auto& value) { out << value; });
        out << '\n';
    }
    return out.str();
}

void Config::reject_unknown_keys() const {
    std::vector<std::string> asked;
    for (const auto& [key, known] : impl_->asked) asked.push_back(key);
    for (const auto& [key, entry] : impl_->entries) {
        if (entry.known) continue;
        throw InputError(where(key), asked.empty() ? "is unknown; there are no keys to set"
                                                   : "is unknown; " + suggestion(key, asked));
    }
}

std::vector<KnownKey> Config::known_keys() const {
    std::vector<KnownKey> keys;
    for (const auto& [key, known] : impl_->asked) keys.push_back(known);
    return keys;
}

Message Config::where(std::string_view key) const {
    return impl_->where(key);
}

}  // namespace stipple
