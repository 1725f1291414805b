#include <arv.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "capture/open_camera.h"

namespace stipple {
namespace {

TEST(CameraMessagesTest, ArePassedOnOnceAndInPart) {
    std::vector<std::string> told;
    tell_camera_messages([&](std::string_view text) { told.emplace_back(text); });
    for (int frame = 0; frame < 3; ++frame)
        arv_buffer_get_part_region(nullptr, 0, nullptr, nullptr, nullptr, nullptr);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("arv_buffer_get_part_region: assertion"), std::string::npos) << told[0];

    g_debug("of no interest");
    g_warning("%s", std::string(5000, 'x').c_str());
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[1], std::string(200, 'x'));

    for (int i = 0; i < 100; ++i) g_warning("text %d", i);
    EXPECT_EQ(told.size(), 20U);
    tell_camera_messages([](std::string_view) {});
}

}  // namespace
}  // namespace stipple
