#include "study/explore/rivals.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(RivalsTest, OnlyWhatIsChosenReplacesTheSpace) {
    const RivalsChoice scene{.footage = "clips/a.mp4"};
    ASSERT_EQ(scene.replaced().size(), 1);
    EXPECT_EQ(scene.replaced()[0].name, "footage");
    EXPECT_EQ(scene.title(), "Rivals: a.mp4");
    const RivalsChoice all{"pan", "ideal", {"coded best", "1x best"}, "d.npy"};
    ASSERT_EQ(all.replaced().size(), 4);
    EXPECT_EQ(all.replaced()[2].values.size(), 2);
    EXPECT_EQ(all.replaced()[3].name, "decoder.dictionary");
}

}  // namespace
}  // namespace stipple
