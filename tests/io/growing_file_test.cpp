#include "io/growing_file.h"

#include <gtest/gtest.h>

#include <thread>

#include "core/error.h"
#include "io/partial_output.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr double kLongS = 60;  // only a wait without end reaches it

bool goes_on() {
    return false;
}

TEST(GrowingFileTest, AFileThatExistsIsReadAtOnce) {
    const TemporaryFolder folder;
    write_text(folder / "a", "x");
    EXPECT_TRUE(GrowingFile(folder / "a", 0, goes_on).wait_for_file() == folder / "a");
}

TEST(GrowingFileTest, BeforeItIsCompleteItsHiddenFileIsRead) {
    const TemporaryFolder folder;
    const auto partial = partial_path(folder / "a.stipple", 1, 2);
    std::thread writer([&] { write_text(partial, "x"); });
    EXPECT_TRUE(GrowingFile(folder / "a.stipple", kLongS, goes_on).wait_for_file() == partial);
    writer.join();
}

TEST(GrowingFileTest, AFileThatDoesNotAppearIsAnErrorAfterTheTimeout) {
    const TemporaryFolder folder;
    GrowingFile file(folder / "a", 0, goes_on);
    expect_parts(message_of<InputError>([&] { return file.wait_for_file(); }),
                 {"a: has not appeared within 0 s", "raise timeout"});
    EXPECT_TRUE(file.timed_out());
}

TEST(GrowingFileTest, AStopEndsTheWaitAndIsNoTimeout) {
    const TemporaryFolder folder;
    int looks = 0;
    GrowingFile file(folder / "a", kLongS, [&] { return ++looks == 3; });
    EXPECT_FALSE(file.wait_for_file());
    EXPECT_FALSE(file.timed_out());
    EXPECT_EQ(looks, 3);
}

// With a timeout of 0 only growth since the last call keeps the wait going.
TEST(GrowingFileTest, GrowthBeginsTheTimeoutAnew) {
    GrowingFile file("a", 0, goes_on);
    EXPECT_TRUE(file.more(1));
    EXPECT_TRUE(file.more(5));
    EXPECT_FALSE(file.more(5));
    EXPECT_TRUE(file.timed_out());
    EXPECT_TRUE(file.more(6));
    EXPECT_FALSE(file.timed_out());
}

}  // namespace
}  // namespace stipple
