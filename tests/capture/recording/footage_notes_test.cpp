#include "capture/recording/footage_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A recording of 12 frames, 200 a second, without those of `missing`.
MATCHER_P(Says, part, "") {
    return arg.text().find(part) != std::string::npos;
}

class FootageNotesTest : public testing::Test {
  protected:
    ReadAhead recording(const std::vector<std::uint64_t>& missing) {
        std::vector<CapturedFrame> frames;
        std::uint64_t lost = 0;
        for (std::uint64_t id = 0; id < 12; ++id) {
            if (std::ranges::count(missing, id) > 0) {
                ++lost;
                continue;
            }
            frames.push_back(test_frame(id));
            frames.back().record.lost_before = std::exchange(lost, 0);
        }
        write_recording(file_, frames);
        return ReadAhead(file_, {}, [](const Message&) {});
    }

    static void read_all(ReadAhead& footage) {
        while (!footage.next().empty()) {
        }
    }

    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "a.strec";
    const SensorParams sensor_{.slot_us = 5000};
};

TEST_F(FootageNotesTest, AWholeRecordingOfTheRightRateHasNone) {
    ReadAhead footage = recording({});
    EXPECT_THAT(sensor_notes("a", footage, sensor_, false), IsEmpty());
    read_all(footage);
    EXPECT_THAT(end_notes("a", footage, sensor_, false), IsEmpty());
}

TEST_F(FootageNotesTest, MissingFramesAreCountedAtTheEndOnly) {
    ReadAhead footage = recording({4, 5, 9});
    EXPECT_EQ(recording_note("a", footage), "");
    read_all(footage);
    EXPECT_EQ(recording_note("a", footage),
              "a: has 3 missing or incomplete frames (3 replaced by the previous frame); \"stipple "
              "capture replay\" lists the places");
    ReadAhead one = recording({4});
    read_all(one);
    EXPECT_THAT(recording_note("a", one), HasSubstr("has 1 missing or incomplete frame ("));
}

TEST_F(FootageNotesTest, AnotherRateIsToldUnlessItIsResampled) {
    const SensorParams fast{.slot_us = 1000};
    ReadAhead footage = recording({});
    read_all(footage);
    EXPECT_THAT(end_notes("a", footage, fast, false), ElementsAre(Says("200 frames/s")));
    EXPECT_THAT(end_notes("a", footage, fast, true), IsEmpty());
}

TEST_F(FootageNotesTest, OtherFootageIsToldByWhatItDeclares) {
    std::ofstream(folder_ / "a.raw") << std::string(12, 'x');
    const ReadAhead footage(folder_ / "a.raw",
                            {.max_value = {}, .raw = parse_raw_format("2x3:mono8:black=5:hz=50")},
                            [](const Message&) {});
    EXPECT_THAT(sensor_notes("a", footage, sensor_, false), ElementsAre(Says("50 frames/s")));
    EXPECT_THAT(sensor_notes("a", footage, sensor_, true), IsEmpty());
    SensorParams physical = sensor_;
    physical.mode = SensorMode::kPhysical;
    physical.bit_depth = 8;
    physical.physical.black_level_dn = 20;
    EXPECT_THAT(sensor_notes("a", footage, physical, true),
                ElementsAre(Says("its black level is 5 DN")));
    EXPECT_EQ(recording_note("a", footage), "");
}

}  // namespace
}  // namespace stipple
