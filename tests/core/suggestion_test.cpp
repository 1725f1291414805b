#include "core/text.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

using Names = std::vector<std::string>;

TEST(SuggestionTest, FindsTheNameWithTheFewestEdits) {
    const Names known{"decode", "demo", "emulate"};
    EXPECT_EQ(nearest_name("demos", known), "demo");
    EXPECT_EQ(nearest_name("decde", known), "decode");
    EXPECT_EQ(nearest_name("emolat", known), "emulate");
}

TEST(SuggestionTest, ASwapOfNeighboursIsOneEdit) {
    EXPECT_EQ(nearest_name("pna", {"pan", "dice"}), "pan");
    EXPECT_EQ(nearest_name("nap", {"pan", "dice"}), "");  // two edits of three characters
}

TEST(SuggestionTest, CaseIsNoDifferenceAndABeginningIsEnough) {
    EXPECT_EQ(nearest_name("PAPER", {"paper", "ideal"}), "paper");
    EXPECT_EQ(nearest_name("--lum", {"--max-value", "--luminance"}), "--luminance");
    EXPECT_EQ(nearest_name("full", {"full4x", "full1x"}), "full4x");
}

TEST(SuggestionTest, NamesThatAreNotAlikeAreListed) {
    EXPECT_EQ(nearest_name("colour", {"gain", "offset"}), "");
    EXPECT_EQ(nearest_name("version", {"sensor"}), "");
    EXPECT_EQ(nearest_name("v", {"q", "o"}), "");
    EXPECT_EQ(suggestion("colour", {"gain", "offset"}), "known are gain, offset");
    EXPECT_EQ(suggestion("gian", {"gain", "offset"}), "did you mean \"gain\"?");
}

}  // namespace
}  // namespace stipple
