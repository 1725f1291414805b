#include "explore/space.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/source_tree.h"

namespace stipple {
namespace {

TEST(SpaceTest, TheLastAxisChangesFastest) {
    const Space space = parse_space(
        "[axes]\nsensor = [\"a\", \"b\"]\n[set]\n\"sensor.x\" = [1, 2, 3]\n", "space.toml");
    ASSERT_EQ(space.size(), 6);
    EXPECT_EQ(space.point(0), (SpacePoint{"pan", "a", "random", "fast", "1", "1"}));
    EXPECT_EQ(space.point(1), (SpacePoint{"pan", "a", "random", "fast", "1", "2"}));
    EXPECT_EQ(space.point(5), (SpacePoint{"pan", "b", "random", "fast", "1", "3"}));
    EXPECT_EQ(space.value(space.point(5), "sensor"), "b");
}

TEST(SpaceTest, TheExamplesCanBeRead) {
    int examples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(project_path("config/spaces"))) {
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_GT(parse_space(text, entry.path().string()).size(), 1);
        ++examples;
    }
    EXPECT_EQ(examples, 5);
}

}  // namespace
}  // namespace stipple
