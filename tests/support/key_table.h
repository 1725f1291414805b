#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"

namespace stipple {

/// The keys of a table of docs/, `| `key`, `key` | ... |`: the cells of each, by key. Where a row
/// has several keys and as many values in a cell, each key has its own.
[[nodiscard]] std::map<std::string, std::vector<std::string>> key_table(const std::string& page,
                                                                        std::string_view heading);

/// The keys of the table are those that were asked for, with their defaults and ranges where the
/// reader tells them and the cells `fallback_cell` and `range_cell` (from 0; -1: none) hold
/// numbers.
void expect_documented(const std::vector<KnownKey>& known,
                       const std::map<std::string, std::vector<std::string>>& table,
                       int fallback_cell, int range_cell);

}  // namespace stipple
