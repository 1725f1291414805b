#include "stream/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace stipple {
namespace {

/// Bytes of the UTF-8 sequence that begins with `lead`; 0 if none does.
std::size_t sequence_length(std::uint8_t lead) {
    if (lead < 0x80) return 1;
    if (lead >= 0xC2 && lead <= 0xDF) return 2;
    if (lead >= 0xE0 && lead <= 0xEF) return 3;
    if (lead >= 0xF0 && lead <= 0xF4) return 4;
    return 0;
}

/// A character of UTF-8.
struct Character {
    std::size_t bytes;  ///< 0: there is none
    char32_t code;
};

/// The one that `text` begins with.
Character first_character(std::string_view text) {
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    constexpr Character kNone{0, 0};
    const auto lead = static_cast<std::uint8_t>(text.front());
    const std::size_t length = sequence_length(lead);
    if (length == 0 || length > text.size()) return kNone;
    char32_t code = length == 1 ? lead : lead & (0x7FU >> length);
    for (const char c : text.substr(1, length - 1)) {
        const auto next = static_cast<std::uint8_t>(c);
        if ((next & 0xC0U) != 0x80) return kNone;
        code = code << 6U | (next & 0x3FU);
    }
    if (code < kLeast[length] || code > 0x10FFFF) return kNone;
    if (code >= 0xD800 && code <= 0xDFFF) return kNone;
    return {length, code};
}

bool is_control(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code <= 0x9F);
}

/// Line and paragraph separator, and what turns the direction of the text behind it.
bool changes_layout(char32_t code) {
    return (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

bool is_plain_text(std::string_view text, bool lines) {
    while (!text.empty()) {
        const auto [bytes, code] = first_character(text);
        if (bytes == 0) return false;
        const bool of_lines = code == '\t' || code == '\n' || code == '\r';
        if (of_lines ? !lines : is_control(code)) return false;
        text.remove_prefix(bytes);
    }
    return true;
}

std::string terminal_text(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    while (!text.empty()) {
        const auto [bytes, code] = first_character(text);
        const bool of_lines = code == '\t' || code == '\n';
        if (bytes == 0)
            shown += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
        else if ((is_control(code) && !of_lines) || changes_layout(code))
            shown += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(code));
        else
            shown += text.substr(0, bytes);
        text.remove_prefix(std::max<std::size_t>(bytes, 1));
    }
    return shown;
}

}  // namespace stipple
