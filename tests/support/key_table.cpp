#include "tests/support/key_table.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "tests/support/source_tree.h"

namespace stipple {
namespace {

std::string trimmed(std::string text) {
    const auto first = text.find_first_not_of(' ');
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(trimmed(part));
    return parts;
}

std::optional<double> number(const std::string& text) {
    try {
        std::size_t end = 0;
        const double value = std::stod(text, &end);
        if (end == text.size()) return value;
    } catch (const std::exception&) {
        // A text for people.
    }
    return std::nullopt;
}

/// "min..max" or "min .. max".
std::optional<std::pair<double, double>> range(const std::string& text) {
    const auto dots = text.find("..");
    if (dots == std::string::npos) return std::nullopt;
    const auto min = number(trimmed(text.substr(0, dots)));
    const auto max = number(trimmed(text.substr(dots + 2)));
    if (!min || !max) return std::nullopt;
    return std::pair(*min, *max);
}

/// Words in backticks, "`"a"`, `b`", as "a, b"; none of a text for people.
std::optional<std::string> words(const std::string& text) {
    if (!text.starts_with('`') || !text.ends_with('`')) return std::nullopt;
    std::string plain;
    for (const char c : text)
        if (c != '`' && c != '"') plain += c;
    return plain.empty() ? text.substr(1, text.size() - 2) : plain;
}

/// The cells of a row by the names of their columns.
using Row = std::map<std::string, std::string>;

/// The keys of a row, each with its own cells.
void add_keys(const Row& row, KeyTable& table) {
    const auto keys = split(row.begin()->second, ',');
    const auto cell = [&](const char* column, std::size_t key) {
        const auto found = row.find(column);
        if (found == row.end()) return std::string();
        const auto each = split(found->second, ',');
        return each.size() == keys.size() ? each[key] : found->second;
    };
    for (std::size_t key = 0; key < keys.size(); ++key)
        table[keys[key].substr(1, keys[key].size() - 2)] = {cell("unit", key), cell("default", key),
                                                            cell("range", key)};
}

}  // namespace

KeyTable key_table(const std::string& page, std::string_view heading, std::string_view kind) {
    std::ifstream file(project_path(page));
    KeyTable table;
    bool inside = heading.empty();
    std::vector<std::string> columns;  // of a table of keys
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("## ")) inside = heading.empty() || line.substr(3) == heading;
        if (!line.starts_with('|')) columns.clear();
        if (line.starts_with("| key") && line.find("| default |") != std::string::npos)
            columns = split(line.substr(1), '|');
        if (!inside || columns.empty() || !line.starts_with("| `")) continue;
        const auto cells = split(line.substr(1), '|');
        Row row{{"", cells.front()}};
        for (std::size_t i = 1; i < cells.size(); ++i) row[columns.at(i)] = cells[i];
        if (const auto kinds = row.find("kinds"); kinds != row.end()) {
            const auto named = split(kinds->second, ',');
            if (kinds->second != "all" && std::ranges::find(named, kind) == named.end()) continue;
        }
        add_keys(row, table);
    }
    return table;
}

void expect_documented(const std::vector<KnownKey>& known, const KeyTable& table) {
    std::set<std::string> read, written;
    for (const KnownKey& key : known) read.insert(key.name);
    for (const auto& [key, documented] : table) written.insert(key);
    EXPECT_EQ(read, written);
    for (const KnownKey& key : known) {
        SCOPED_TRACE(key.name);
        EXPECT_FALSE(key.text.empty());
        const auto row = table.find(key.name);
        if (row == table.end()) continue;
        const DocumentedKey& page = row->second;
        EXPECT_EQ(page.unit, key.unit);
        if (const auto value = number(page.fallback)) {
            EXPECT_EQ(number(key.fallback), value);
        } else if (const auto text = words(page.fallback)) {
            EXPECT_EQ(*text, key.fallback);
        } else if (page.fallback.empty()) {
            EXPECT_EQ(key.fallback, "");
        }
        if (const auto values = range(key.range)) {
            EXPECT_EQ(range(page.range), values);
        } else if (!key.range.empty()) {
            EXPECT_EQ(words(page.range), key.range);
        }
    }
}

}  // namespace stipple
