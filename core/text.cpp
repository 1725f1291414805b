#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <string_view>
#include <utility>

namespace stipple {
namespace {

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

/// Optimal string alignment: Levenshtein's distance, in which a swap of neighbours is one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = std::exchange(last, row);
    }
    return last.back();
}

}  // namespace

std::string shape_text(FrameShape shape) {
    return fmt::format("{} x {} x {}", shape.cols, shape.rows, shape.planes);
}

std::string shape_difference(FrameShape found, FrameShape wanted, std::string_view others) {
    return fmt::format("has frames of {} (width x height x planes), {} {}", shape_text(found),
                       others, shape_text(wanted));
}

std::string shell_quoted(const std::string& argument) {
    constexpr std::string_view kPlain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,%+@-";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos)
        return argument;
    std::string text = "'";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
    const std::string wanted = lower_case(name);
    std::string nearest;
    std::size_t fewest = 1 + wanted.size() / 3;  // a third of them is near enough
    for (const std::string& candidate : known) {
        const std::string text = lower_case(candidate);
        const std::size_t edits = text.starts_with(wanted) ? 0 : edit_distance(wanted, text);
        if (edits >= fewest) continue;
        fewest = edits;
        nearest = candidate;
    }
    return nearest;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? fmt::format("known are {}", joined(known))
                           : fmt::format("did you mean \"{}\"?", nearest);
}

}  // namespace stipple
