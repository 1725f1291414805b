#include "study/explore/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace stipple {
namespace {

using testing::HasSubstr;
using testing::Not;

/// With values of each type, and texts that a shell or TOML could take for something else.
const std::string kSpace = R"(
[axes]
footage = "dice"
sensor = ["my sensor.toml", "-x"]
schedule = "tiled"
method = "fast"
seed = [3, 18446744073709551615]
[set]
"schedule.exposure_slots" = [[1, 2], [4]]
"sensor.read_noise_e" = [2.5, 3]
"sensor.shot_noise" = true
"sensor.name" = ["a'b", "true story", "line\nEND\nrm"]
"decoder.rounds" = 2
[clip]
frames = 20
rows = 24
planes = 1
[readout]
rows = 100
cols = 200
)";

Space space() {
    std::string text = kSpace;
    text.replace(text.find("18446744073709551615"), 20, "\"18446744073709551615\"");
    return parse_space(text, "space.toml");
}

TEST(PointCommandsTest, APointOfAnOwnDecoderIsForPython) {
    Space all = space();
    all.decoders = {{"own'decoder", {}}};
    all.set_methods({"own'decoder"});
    const std::string text = point_commands(all, all.point(0), {12, {3, 9}, true});
    EXPECT_THAT(text, HasSubstr("\nEND\n# Then stipple.explore in Python, with the decoder "
                                "\"own'decoder\""));
    EXPECT_THAT(text, Not(HasSubstr("\nstipple ")));
}

TEST(PointCommandsTest, ThePointIsASpaceOfItsOwn) {
    const Space all = space();
    for (std::uint64_t number = 0; number < all.size(); ++number) {
        const SpacePoint point = all.point(number);
        const std::string text = point_space(all, point, {12, {3, 9}, true});
        const Space one = parse_space(text, "point.toml");
        ASSERT_EQ(one.size(), 1) << text;
        ASSERT_EQ(one.axes.size(), all.axes.size());
        for (const SpaceAxis& axis : all.axes)
            EXPECT_EQ(one.value(one.point(0), axis.name), all.value(point, axis.name)) << text;
        EXPECT_EQ(one.frames, 12);
        EXPECT_EQ(one.compared, (ComparedSlots{3, 9}));
        EXPECT_EQ(one.scene, all.scene);
        EXPECT_EQ(one.readout, all.readout);
        // Nothing but its end ends the text in the shell.
        EXPECT_THAT("\n" + text, Not(HasSubstr("\nEND\n")));
    }
}

TEST(PointCommandsTest, StepsAreQuotedForAShell) {
    const Space all = space();
    const std::string steps = point_commands(all, all.point(0), {20, {4, 16}, true});
    EXPECT_THAT(steps, HasSubstr("stipple synth dice -o scene.npy --frames 20 --size 64x24 "
                                 "--luminance\n"));
    EXPECT_THAT(steps, HasSubstr("stipple emulate scene.npy -o clip.stipple --sensor 'my "
                                 "sensor.toml' --schedule tiled --seed 3"));
    EXPECT_THAT(steps, HasSubstr("--set 'schedule.exposure_slots=[ 1, 2 ]'"));
    EXPECT_THAT(steps, HasSubstr("--method fast --set decoder.rounds=2\n"));
    EXPECT_THAT(steps, HasSubstr("--margin 4 --max-value 2\n"));
    EXPECT_THAT(point_commands(all, all.point(all.size() - 1), {20, {4, 16}, true}),
                HasSubstr("--sensor ./-x"));
}

TEST(PointCommandsTest, ARigHasStepsIfItIsUsedAsItIs) {
    const std::string begin = "[axes]\nsensor = 'paper'\nrig = 'flutter'\n";
    const auto commands = [&](const std::string& more) {
        const Space one = parse_space(begin + more, "space.toml");
        return point_commands(one, one.point(0), {20, {4, 16}, true});
    };
    const std::string steps = commands("[set]\n'rig.one.share' = 0.25\n");
    EXPECT_THAT(steps, HasSubstr("rig = [ \"flutter\" ]"));
    EXPECT_THAT(steps,
                HasSubstr("emulate scene.npy -o clip --rig flutter --set rig.one.share=0.25\n"));
    EXPECT_THAT(steps, HasSubstr("decode clip -o decoded.npy --method fast\n"));
    EXPECT_THAT(commands("seed = 2\n"), Not(HasSubstr("emulate")));
    EXPECT_THAT(commands("[set]\n'sensor.bit_depth' = 9\n"), Not(HasSubstr("emulate")));
}

TEST(PointCommandsTest, FootageIsReadAndComparedAlike) {
    const Space one = parse_space("[axes]\nsensor = 'paper'\nfootage = 'clip.mp4'\n", "s.toml");
    PointClip clip{32, {7, 24}, true};
    EXPECT_THAT(point_commands(one, one.point(0), clip),
                HasSubstr("compare decoded.npy clip.mp4 --until 31 --margin 7 --max-value 2\n"));
    clip.reading = {.transfer = Transfer::kSrgb, .luminance = true, .max_value = {}, .scale = 2};
    clip.reading.part = {.frames = {2, {}}, .crop = CropArea{8, 16}, .bin = 2};
    const std::string options =
        " --transfer srgb --luminance --frames 2: --crop 16x8 --bin 2 --scale 2";
    const std::string commands = point_commands(one, one.point(0), clip);
    EXPECT_THAT(commands, HasSubstr("explore point.toml -o point" + options + "\n"));
    EXPECT_THAT(commands, HasSubstr("clip.stipple" + options + " --truth light.npy --sensor"));
    EXPECT_THAT(commands, HasSubstr("compare decoded.npy light.npy --until 31"));
    clip.compared = {9, 24};  // which compare cannot do
    EXPECT_THAT(point_commands(one, one.point(0), clip), Not(HasSubstr("stipple compare")));
}

TEST(PointCommandsTest, BinnedSensorsAndWindowsHaveNoSteps) {
    const Space one = parse_space(
        "[axes]\nsensor = 'paper'\nbinning = 2\nbinning_mode = 'charge'\n", "space.toml");
    const std::string commands = point_commands(one, one.point(0), {20, {4, 16}, true});
    EXPECT_THAT(commands, HasSubstr("binning = [ 2 ]\nbinning_mode = [ \"charge\" ]"));
    EXPECT_THAT(commands, Not(HasSubstr("emulate")));
    // A point that cannot be set up has them too.
    const Space wrong = parse_space("[axes]\nsensor = 'paper'\nbinning = 99\n", "space.toml");
    EXPECT_THAT(point_commands(wrong, wrong.point(0), {20, {}, true}), HasSubstr("[ 99 ]"));
}

TEST(PointCommandsTest, LongerFootageHasNoSteps) {
    const Space all = space();
    EXPECT_THAT(point_commands(all, all.point(0), {20, {4, 16}, false}), Not(HasSubstr("emulate")));
    EXPECT_THAT(point_commands(all, all.point(0), {20, {4, 16}, false}),
                HasSubstr("stipple explore"));
}

}  // namespace
}  // namespace stipple
