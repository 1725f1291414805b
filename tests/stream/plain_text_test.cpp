#include "stream/plain_text.h"

#include <gtest/gtest.h>

#include <utility>

namespace stipple {
namespace {

TEST(PlainTextTest, ATerminalIsShownTheCodesOfWhatControlsIt) {
    using namespace std::string_literals;
    const std::pair<std::string, std::string> cases[] = {
        {"a\tb\nc", "a\tb\nc"},
        {"\x1b[31m\r\0"s, "\\u001b[31m\\u000d\\u0000"},
        {"\x7f\u0080\u009f\u00a0", "\\u007f\\u0080\\u009f\u00a0"},
        {"\u2027\u2028\u2029\u202a\u202e\u202f", "\u2027\\u2028\\u2029\\u202a\\u202e\u202f"},
        {"\u2065\u2066\u2069\u206a", "\u2065\\u2066\\u2069\u206a"},
        {"Größe 大小 \U0001F4F7", "Größe 大小 \U0001F4F7"},
    };
    for (const auto& [text, shown] : cases) EXPECT_EQ(terminal_text(text), shown);
}

TEST(PlainTextTest, ATerminalIsShownTheBytesThatAreNoUtf8) {
    const std::pair<std::string, std::string> cases[] = {
        {"\x9b"
         "31m",
         "\\x9b31m"},                                  // CSI of 8-bit terminals
        {"\xc0\xaf", "\\xc0\\xaf"},                    // not the shortest form
        {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // a surrogate
        {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond U+10FFFF
        {"\xe5\xa4", "\\xe5\\xa4"},                    // cut off
    };
    for (const auto& [text, shown] : cases) EXPECT_EQ(terminal_text(text), shown);
}

}  // namespace
}  // namespace stipple
