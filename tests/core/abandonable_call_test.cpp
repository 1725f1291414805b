#include "core/abandonable_call.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

namespace stipple {
namespace {

TEST(AbandonableCallTest, GivesWhatTheWorkGives) {
    EXPECT_EQ(call_unless([] { return 3; }, [] { return false; }), 3);
    EXPECT_THROW(static_cast<void>(call_unless([]() -> int { throw std::runtime_error("no"); },
                                               [] { return false; })),
                 std::runtime_error);
}

TEST(AbandonableCallTest, WorkThatDoesNotEndIsLeftBehind) {
    auto release = std::make_shared<std::promise<void>>();
    auto ended = std::make_shared<std::promise<void>>();
    EXPECT_FALSE(call_unless(
        [release, ended] {
            release->get_future().wait();
            ended->set_value();
            return 1;
        },
        [] { return true; }));
    release->set_value();
    ended->get_future().wait();
}

}  // namespace
}  // namespace stipple
