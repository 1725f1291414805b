#include "session/video_shards.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(WindowMarkTest, HasTheChecksumOfTheDecoding) {
    EXPECT_EQ(window_mark(3, "123456789"), "window 3 of e3069283");  // check value of CRC-32C
}

}  // namespace
}  // namespace stipple
