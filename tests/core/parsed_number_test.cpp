#include "core/text.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace stipple {
namespace {

TEST(ParsedNumberTest, TakesWholeTexts) {
    EXPECT_EQ(parsed_number<int>("-12"), -12);
    EXPECT_EQ(parsed_number<double>("2.5e-1"), 0.25);
    EXPECT_EQ(parsed_number<std::uint32_t>("ffff", 16), 65535U);
    EXPECT_EQ(parsed_number<std::int64_t>("9223372036854775807"), INT64_MAX);
}

TEST(ParsedNumberTest, RefusesWhatIsNotANumberFromItsBeginToItsEnd) {
    for (const char* const text : {"", " 1", "1 ", "1x", "x", "+1", "0x1", "1.5", "-", "1,0"})
        EXPECT_FALSE(parsed_number<int>(text)) << text;
    for (const char* const text : {"", " 1", "1 ", "1e", "+1", "1.5.", "."})
        EXPECT_FALSE(parsed_number<double>(text)) << text;
}

TEST(ParsedNumberTest, RefusesWhatTheTypeCannotHold) {
    EXPECT_FALSE(parsed_number<std::uint8_t>("256"));
    EXPECT_FALSE(parsed_number<std::uint32_t>("-1"));
    EXPECT_FALSE(parsed_number<std::int64_t>("9223372036854775808"));
    EXPECT_FALSE(parsed_number<double>("1e400"));
}

}  // namespace
}  // namespace stipple
