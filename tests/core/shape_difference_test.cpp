#include "core/text.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(ShapeDifferenceTest, SizesAreWidthTimesHeightTimesPlanes) {
    EXPECT_EQ(shape_text({.rows = 480, .cols = 640, .planes = 3}), "640 x 480 x 3");
    EXPECT_EQ(shape_difference({.rows = 6, .cols = 8, .planes = 3},
                               {.rows = 6, .cols = 8, .planes = 1}, "but the reference has"),
              "has frames of 8 x 6 x 3 (width x height x planes), but the reference has 8 x 6 x 1");
}

}  // namespace
}  // namespace stipple
