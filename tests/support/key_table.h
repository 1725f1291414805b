#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"

namespace stipple {

/// What a page says of a key.
struct DocumentedKey {
    std::string unit;
    std::string fallback;
    std::string range;
};
using KeyTable = std::map<std::string, DocumentedKey>;

/// The tables of docs/ under `heading` (empty: of the whole page) with the columns `key` and
/// `default`, and `unit` and `range` where they have them. Where a row has several keys and as many
/// values in a cell, each key has its own. Of tables with a column `kinds` the rows that name
/// `kind` or "all".
[[nodiscard]] KeyTable key_table(const std::string& page, std::string_view heading,
                                 std::string_view kind = {});

/// The keys of the table are those that were asked for, with the same units, ranges and defaults;
/// a default or a range that is neither a number nor in backticks is for people.
void expect_documented(const std::vector<KnownKey>& known, const KeyTable& table);

}  // namespace stipple
