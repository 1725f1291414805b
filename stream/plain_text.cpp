#include "stream/plain_text.h"

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

bool is_allowed(char32_t code, std::size_t length, bool lines) {
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < kLeast[length] || code > 0x10FFFF) return false;
    if (code >= 0xD800 && code <= 0xDFFF) return false;
    if (code == '\t' || code == '\n' || code == '\r') return lines;
    return code >= 0x20 && (code < 0x7F || code > 0x9F);
}

}  // namespace

bool is_plain_text(std::string_view text, bool lines) {
    while (!text.empty()) {
        const auto lead = static_cast<std::uint8_t>(text.front());
        const std::size_t length = sequence_length(lead);
        if (length == 0 || length > text.size()) return false;
        char32_t code = length == 1 ? lead : lead & (0x7FU >> length);
        for (const char c : text.substr(1, length - 1)) {
            const auto next = static_cast<std::uint8_t>(c);
            if ((next & 0xC0U) != 0x80) return false;
            code = code << 6U | (next & 0x3FU);
        }
        if (!is_allowed(code, length, lines)) return false;
        text.remove_prefix(length);
    }
    return true;
}

}  // namespace stipple
