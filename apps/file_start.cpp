#include "apps/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "stream/buffered_reader.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

constexpr std::size_t kStartBytes = 64;
constexpr std::size_t kShownBytes = 8;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r\n";

struct Magic {
    std::string_view start, kind;
};

constexpr std::array kMagics{Magic{"PK\x03\x04", "a ZIP archive"},
                             Magic{"\x1F\x8B", "a gzip archive"}, Magic{"%PDF", "a PDF document"},
                             Magic{"\x89HDF", "an HDF5 file"}};

bool is_html(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return lower.starts_with("<!doctype html") || lower.starts_with("<html");
}

/// Without the bytes of a character whose end is not in `text`.
std::string_view whole_characters(std::string_view text) {
    constexpr std::size_t kMaxBytes = 4;
    for (std::size_t cut = 0; cut < std::min(kMaxBytes, text.size()); ++cut)
        if (const auto whole = text.substr(0, text.size() - cut); is_plain_text(whole, true))
            return whole;
    return {};
}

std::string hexadecimal(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes)
        text += fmt::format(" {:02x}", static_cast<unsigned>(static_cast<std::uint8_t>(byte)));
    return text;
}

std::string kind_of(std::string_view start) {
    if (start.empty()) return "an empty file";
    for (const auto& [magic, kind] : kMagics)
        if (start.starts_with(magic)) return std::string(kind);
    std::string_view text = whole_characters(start);
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (is_html(text)) return "a web page (HTML)";
    if (const auto line = text.substr(0, text.find_first_of("\r\n")); !line.empty())
        return fmt::format("text that begins \"{}\"", line);
    return "a file that begins with the bytes" + hexadecimal(start.substr(0, kShownBytes));
}

}  // namespace

std::string sniff_file_type(const std::string& file) {
    BufferedReader window(file);
    const std::span<const std::uint8_t> bytes = window.peek(kStartBytes);
    return kind_of(std::string(bytes.begin(), bytes.end()).substr(0, kStartBytes));
}

}  // namespace stipple
