#include "core/own_folders.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

TEST(OwnFoldersTest, OfAProgramAreItsOwnOnly) {
    const fs::path program = fs::read_symlink("/proc/self/exe");
    EXPECT_EQ(own_folders(), std::vector<fs::path>{program.parent_path()});
}

TEST(OwnFoldersTest, AFolderLiesInItselfAndInThoseAbove) {
    EXPECT_TRUE(lies_in("/a/b", "/a/b"));
    EXPECT_TRUE(lies_in("/a/b/c/d", "/a/b"));
    EXPECT_FALSE(lies_in("/a/bc", "/a/b"));
    EXPECT_FALSE(lies_in("/a", "/a/b"));
    EXPECT_FALSE(lies_in("/a/b/../c", "/a/b"));
}

TEST(OwnFoldersTest, AFolderLiesInWhatALinkLeadsTo) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "real/inner");
    fs::create_directory_symlink(folder / "real", folder / "link");
    EXPECT_TRUE(lies_in(folder / "real/inner", folder / "link"));
    EXPECT_TRUE(lies_in(folder / "link/inner", folder / "real"));
}

}  // namespace
}  // namespace stipple
