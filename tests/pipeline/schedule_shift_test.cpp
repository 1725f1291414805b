// A wrong schedule is found out on real footage.
#include <gtest/gtest.h>

#include "decoder/schedule_check/schedule_check.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/pipeline/clip.h"
#include "tests/support/footage_folder.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 1;

/// What is found of a chip that ran `schedule` with this shift.
ScheduleCheck check_shifted(const FluxVideo& video, const ExposureSchedule& schedule,
                            const ScheduleShift& shift) {
    const TemporaryFolder folder;
    const NamedSchedule run{"run", {}, shifted_schedule(schedule, shift)};
    write_recording(video, run, kSeed, folder / "clip.stipple");
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kAnySchedule);
    reader.use_schedule(schedule);
    return check_schedule(reader);
}

/// A clip; the highest residual of the right shift that was measured, and the least median of all.
struct ClipResiduals {
    std::string name;
    double best;
    double median;
};

class ScheduleShiftOnFootageTest : public testing::TestWithParam<ClipResiduals> {};

TEST_P(ScheduleShiftOnFootageTest, IsFoundAndTheRightScheduleIsNotFlagged) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    const FrameShape shape = video->shape();
    for (const auto& schedule : {tiled_schedule(16, 16, kPaperExposureSlots, kSeed),
                                 random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1)})
        for (const ScheduleShift shift :
             {ScheduleShift{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {-4, 6, 5}}) {
            const ScheduleCheck check = check_shifted(*video, schedule, shift);
            EXPECT_EQ(check.verdict, shift == ScheduleShift{} ? ScheduleCheck::Verdict::kAgrees
                                                              : ScheduleCheck::Verdict::kShifted);
            EXPECT_EQ(check.shift, shift)
                << check.shift.slots << ' ' << check.shift.rows << ' ' << check.shift.cols;
            EXPECT_LT(check.best_residual, GetParam().best);
            EXPECT_GT(check.median_residual, GetParam().median);
        }
}

INSTANTIATE_TEST_SUITE_P(Clips, ScheduleShiftOnFootageTest,
                         testing::Values(ClipResiduals{"mouse250_a", 0.106, 0.447},
                                         ClipResiduals{"nat30_coffee", 0.124, 0.432},
                                         ClipResiduals{"hdr_stilllife", 0.2493, 0.450}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stipple
