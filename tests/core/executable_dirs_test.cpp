#include "core/executable_dirs.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

namespace fs = std::filesystem;

TEST(OwnFoldersTest, OfAProgramAreItsOwnOnly) {
    const fs::path program = fs::read_symlink("/proc/self/exe");
    EXPECT_EQ(executable_dirs(), std::vector<fs::path>{program.parent_path()});
}

}  // namespace
}  // namespace stipple
