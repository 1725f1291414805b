#include "io/output_names.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(OutputNamesTest, TheExtensionTellsTheKind) {
    EXPECT_EQ(name_problem("a/clip.stipple", kStreamName), "");
    EXPECT_EQ(name_problem("clip.STIPPLE", kStreamName), "");
    EXPECT_EQ(name_problem("clip", kStreamName), "");
    EXPECT_EQ(name_problem("clip.npy", kStreamName), kStreamName.rule);
    EXPECT_EQ(name_problem("clip.tiff", kVideoName), "");
    EXPECT_EQ(name_problem("clip.anything", OutputName{}), "");
}

TEST(OutputNamesTest, SomeKindsNeedAnExtension) {
    EXPECT_EQ(name_problem("page", kPageName), kPageName.rule);
    EXPECT_EQ(name_problem("page.htm", kPageName), "");
}

TEST(OutputNamesTest, AnExtensionAloneIsNoName) {
    EXPECT_EQ(name_problem("a/.stipple", kStreamName),
              "is an extension only; put a name before it");
    EXPECT_EQ(name_problem("a/.hidden", kStreamName), "");
}

TEST(OutputNamesTest, FoldersAndDevicesThatExistMayHaveAnyName) {
    const TemporaryFolder folder;
    EXPECT_EQ(name_problem("/dev/null", kDiagramName), "");
    std::filesystem::create_directory(folder / "a.npy");
    EXPECT_EQ(name_problem(folder / "a.npy", kStreamName), "");
}

}  // namespace
}  // namespace stipple
