#include "study/explore/space.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

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

TEST(SpaceTest, ARigStandsInPlaceOfASchedule) {
    const Space space = parse_space(
        "[axes]\nsensor = 'paper'\n[[systems]]\nname = 'a'\nschedule = 'full4x'\nmethod = 'fast'\n"
        "[[systems]]\nname = 'b'\nrig = 'flutter'\nmethod = 'best'\n"
        "set = { 'rig.one.share' = 0.2, 'sensor.bit_depth' = 10 }\n",
        "space.toml");
    ASSERT_EQ(space.size(), 2);
    const SpacePoint a = space.point(0), b = space.point(1);
    EXPECT_EQ(space.value(a, "schedule") + space.rig(a), "full4x");
    EXPECT_EQ(space.value(b, "schedule") + space.rig(b), "flutter");
    EXPECT_EQ(space.settings(b, "rig"), std::vector<std::string>{"one.share=0.2"});
    EXPECT_EQ(space.settings(b, "sensor"), std::vector<std::string>{"bit_depth=10"});
    EXPECT_TRUE(space.settings(a, "rig").empty());

    const Space rigs = parse_space("[axes]\nsensor = 'paper'\nrig = ['x', 'y']\n", "space.toml");
    ASSERT_EQ(rigs.size(), 2);
    EXPECT_EQ(rigs.rig(rigs.point(1)), "y");
    EXPECT_EQ(rigs.value(rigs.point(1), "schedule"), "");
}

TEST(SpaceTest, AKeyThatSystemsSetIsReplacedInThem) {
    Space space = parse_space(
        "[axes]\nsensor = 'paper'\n[[systems]]\nname = 'a'\nschedule = 'full4x'\nmethod = 'fast'\n"
        "[[systems]]\nname = 'b'\nschedule = 'full4x'\nmethod = 'hitomi2011'\n"
        "set = { 'decoder.dictionary' = 'x.npy' }\n",
        "space.toml");
    space.replace({"decoder.dictionary", {"y.npy"}});
    EXPECT_TRUE(space.settings(space.point(0), "decoder").empty());
    EXPECT_EQ(space.settings(space.point(1), "decoder"),
              std::vector<std::string>{"dictionary=y.npy"});
}

TEST(SpaceTest, MethodsReplaceThoseOfTheAxis) {
    Space space =
        parse_space("[axes]\nsensor = 'paper'\nmethod = ['fast', 'best']\n", "space.toml");
    space.set_methods({"naive", "own", "best"});
    ASSERT_EQ(space.size(), 3);
    EXPECT_EQ(space.value(space.point(1), "method"), "own");
}

TEST(SpaceTest, EachSystemOfOneSensorAndTheMethodBestHasACopyForEachMethod) {
    Space space = parse_space(
        "[axes]\nsensor = 'paper'\n"
        "[[systems]]\nname = 'coded best'\nschedule = 'random'\nmethod = 'best'\n"
        "set = { 'decoder.iterations' = 3, 'sensor.bit_depth' = 10 }\n"
        "[[systems]]\nname = 'coded fast'\nschedule = 'random'\nmethod = 'fast'\n"
        "[[systems]]\nname = 'bestial best (x)'\nschedule = 'full1x'\nmethod = 'best'\n"
        "[[systems]]\nname = 'frames'\nschedule = 'full4x'\nmethod = 'best'\n"
        "[[systems]]\nname = 'rig best'\nrig = 'flutter'\nmethod = 'best'\n",
        "space.toml");
    space.set_methods({"best", "own"});
    std::vector<std::string> names;
    for (std::uint64_t number = 0; number < space.size(); ++number)
        names.push_back(space.value(space.point(number), "system"));
    EXPECT_EQ(names, (std::vector<std::string>{"coded best", "coded fast", "bestial best (x)",
                                               "frames", "rig best", "coded own", "bestial own (x)",
                                               "frames best", "frames own"}));
    const SpacePoint own = space.point(5);
    EXPECT_EQ(space.value(own, "schedule") + " " + space.value(own, "method"), "random own");
    EXPECT_EQ(space.settings(own, "sensor"), std::vector<std::string>{"bit_depth=10"});
    EXPECT_TRUE(space.settings(own, "decoder").empty());
    EXPECT_EQ(space.settings(space.point(0), "decoder"), std::vector<std::string>{"iterations=3"});
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
