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

}  // namespace

std::map<std::string, std::vector<std::string>> key_table(const std::string& page,
                                                          std::string_view heading) {
    std::ifstream file(project_path(page));
    std::map<std::string, std::vector<std::string>> table;
    bool inside = heading.empty(), of_keys = false;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("## ")) inside = heading.empty() || line.substr(3) == heading;
        if (line.starts_with("| key")) of_keys = line.find("| default |") != std::string::npos;
        if (!line.starts_with('|')) of_keys = false;
        if (!inside || !of_keys || !line.starts_with("| `")) continue;
        const auto row = split(line.substr(1), '|');
        const auto keys = split(row[0], ',');
        for (std::size_t key = 0; key < keys.size(); ++key) {
            auto& cells = table[keys[key].substr(1, keys[key].size() - 2)];
            for (std::size_t i = 1; i < row.size(); ++i) {
                const auto each = split(row[i], ',');
                cells.push_back(each.size() == keys.size() ? each[key] : row[i]);
            }
        }
    }
    return table;
}

void expect_documented(const std::vector<KnownKey>& known,
                       const std::map<std::string, std::vector<std::string>>& table,
                       int fallback_cell, int range_cell) {
    std::set<std::string> read, written;
    for (const KnownKey& key : known) read.insert(key.name);
    for (const auto& [key, cells] : table) written.insert(key);
    EXPECT_EQ(read, written);
    for (const KnownKey& key : known) {
        const auto row = table.find(key.name);
        if (row == table.end()) continue;
        const auto cell = [&](int index) {
            return index < 0 ? std::string() : row->second.at(static_cast<std::size_t>(index));
        };
        if (const auto value = number(cell(fallback_cell))) {
            EXPECT_EQ(number(key.fallback), value) << key.name;
        }
        if (const auto values = range(key.range); values && range_cell >= 0) {
            EXPECT_EQ(range(cell(range_cell)), values) << key.name;
        }
    }
}

}  // namespace stipple
