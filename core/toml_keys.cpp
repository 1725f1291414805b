#include "core/config.h"

#include <algorithm>

namespace stipple {
namespace {

/// The length of the string, with its quotes, that `text` begins with; all of it if it has no end.
std::size_t string_length(std::string_view text) {
    const char quote = text.front();
    const bool lines = text.size() >= 3 && text[1] == quote && text[2] == quote;
    const std::string_view end = text.substr(0, lines ? 3 : 1);
    for (std::size_t i = end.size(); i < text.size(); ++i) {
        if (text[i] == '\\' && quote == '"')
            ++i;
        else if (text.substr(i).starts_with(end))
            return i + end.size();
        else if (text[i] == '\n' && !lines)
            return i;
    }
    return text.size();
}

std::size_t comment_length(std::string_view text) {
    return std::min(text.find('\n'), text.size());
}

}  // namespace

std::size_t line_of_long_key(std::string_view toml) {
    constexpr std::string_view kEndsKey = "\n=,[]{}";
    std::size_t line = 1;
    std::size_t parts = 1;
    while (!toml.empty()) {
        const char c = toml.front();
        const std::size_t length = c == '"' || c == '\'' ? string_length(toml)
                                   : c == '#'            ? comment_length(toml)
                                                         : 1;
        if (kEndsKey.find(c) != std::string_view::npos) parts = 1;
        if (c == '.' && ++parts > kMaxKeyParts) return line;
        const std::string_view piece = toml.substr(0, length);
        line += static_cast<std::size_t>(std::count(piece.begin(), piece.end(), '\n'));
        toml.remove_prefix(length);
    }
    return 0;
}

}  // namespace stipple
