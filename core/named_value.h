#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.h"

namespace stipple {

/// A value with its name on the command line, in Python and in files. The values of a type are a
/// table, from which all of them take the names.
template <typename Value>
struct NamedValue {
    std::string_view name;
    Value value;
};

/// The name of a value of the table; empty if it has none.
template <typename Value, std::size_t kCount>
[[nodiscard]] constexpr std::string_view name_in(const std::array<NamedValue<Value>, kCount>& table,
                                                 Value value) {
    for (const NamedValue<Value>& named : table)
        if (named.value == value) return named.name;
    return {};
}

/// The names of a table of all values of an enumeration, in their order: what ConfigKey::choices
/// takes.
template <const auto& kTable>
inline constexpr auto kNamesOf = [] {
    std::array<std::string_view, kTable.size()> names;
    for (std::size_t i = 0; i < kTable.size(); ++i) {
        if (static_cast<std::size_t>(kTable[i].value) != i) throw "the table lacks a value";
        names[i] = kTable[i].name;
    }
    return names;
}();

/// The value of that name. \throws InputError at `where`, with all names, if there is none.
template <typename Value, std::size_t kCount>
[[nodiscard]] Value value_in(const std::array<NamedValue<Value>, kCount>& table,
                             std::string_view name, std::string_view where) {
    std::string names;
    for (const NamedValue<Value>& named : table) {
        if (named.name == name) return named.value;
        names.append(names.empty() ? "" : ", ").append(named.name);
    }
    throw InputError(where, "\"" + std::string(name) + "\" is none of " + names);
}

}  // namespace stipple
