#include "decoder/schedule_check/schedule_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/stream_writer.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Verdict = ScheduleCheck::Verdict;

constexpr FrameShape kShape{48, 64, 1};

/// Waves of light that move to the right, `contrast` around `mean`.
FluxVideo waves(double mean, double contrast, int slots = 40) {
    FluxVideo video(slots, kShape);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                video.plane(slot, 0)(row, col) =
                    static_cast<float>(mean * (1 + contrast * std::sin(0.3 * (col - 0.5 * slot)) *
                                                       std::cos(0.2 * row)));
    return video;
}

/// A chip that ran `schedule` with a shift, and a header that does not know.
ScheduleCheck check_shifted(const FluxVideo& video, const ExposureSchedule& schedule,
                            const ScheduleShift& shift) {
    Recorded recorded = record(video, shifted_schedule(schedule, shift));
    const TemporaryFolder folder;
    {
        StreamWriter writer(folder / "clip.stipple", recorded.header);
        for (const SamplePacket& packet : recorded.packets) writer.write(packet);
        writer.finish();
    }
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kAnySchedule);
    reader.use_schedule(schedule);
    return check_schedule(reader);
}

TEST(ScheduleShiftTest, VisitsWhatTheShiftedScheduleMakesDue) {
    const ExposureSchedule schedule = tiled_schedule(4, 5, kPaperExposureSlots, 1);
    for (const ScheduleShift shift : {ScheduleShift{0, 0, 0}, ScheduleShift{7, 3, 2}}) {
        const ExposureSchedule shifted = shifted_schedule(schedule, shift);
        for (int slot = 0; slot < 20; ++slot)
            for (int row = 0; row < 6; ++row) {
                std::vector<std::pair<int, int>> expected;
                std::vector<std::pair<int, int>> visited;
                const auto list = [](auto& to) {
                    return [&to](int col, const DuePixel& pixel) {
                        to.emplace_back(col, pixel.span_slots);
                    };
                };
                visit_due_pixels(shifted, slot, row, 13, list(expected));
                visit_due_shifted(schedule, shift, {slot, row, 13}, list(visited));
                EXPECT_EQ(visited, expected) << slot << ' ' << row;
            }
    }
}

TEST(ScheduleShiftTest, GoingThereAndBackChangesNothing) {
    const ExposureSchedule schedule = tiled_schedule(4, 5, kPaperExposureSlots, 1);
    EXPECT_EQ(shifted_schedule(shifted_schedule(schedule, {3, 1, -2}), {-3, -1, 2}), schedule);
    EXPECT_EQ(shifted_schedule(schedule, {15, 4, 5}), schedule);
    EXPECT_FALSE(shifted_schedule(schedule, {1, 0, 0}) == schedule);
}

TEST(ScheduleCheckTest, DoesNotFlagTheRightSchedule) {
    for (const double contrast : {0.0, 0.7})
        for (const auto& schedule : {tiled_schedule(16, 16, kPaperExposureSlots, 1),
                                     random_schedule(48, 64, kPaperExposureSlots, 1)}) {
            const ScheduleCheck check = check_shifted(waves(0.3, contrast), schedule, {});
            EXPECT_EQ(check.verdict, Verdict::kAgrees) << contrast;
            EXPECT_EQ(check.shift, ScheduleShift{});
            EXPECT_EQ(check.header_residual, check.best_residual);
            EXPECT_LT(*check.best_residual, 0.5 * *check.median_residual);
        }
}

TEST(ScheduleCheckTest, FindsTheShiftThatTheChipRan) {
    const ExposureSchedule tiled = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    const ExposureSchedule random = random_schedule(48, 64, kPaperExposureSlots, 1);
    for (const ScheduleShift shift : {ScheduleShift{1, 0, 0},
                                      {-1, 0, 0},
                                      {0, 1, 0},
                                      {0, 0, 1},
                                      {0, -1, 1},
                                      {5, -7, 8},
                                      {-7, 3, -4}})
        for (const ExposureSchedule& schedule : {tiled, random}) {
            const ScheduleCheck check = check_shifted(waves(0.3, 0.7), schedule, shift);
            EXPECT_EQ(check.verdict, Verdict::kShifted);
            EXPECT_EQ(check.shift, shift)
                << check.shift.slots << ' ' << check.shift.rows << ' ' << check.shift.cols;
        }
}

TEST(ScheduleCheckTest, CountsAloneSayWhenAConventionalCameraIsRead) {
    const ScheduleCheck check = check_shifted(waves(0, 0), full_schedule(4, 4), {1, 0, 0});
    EXPECT_EQ(check.verdict, Verdict::kShifted);
    EXPECT_EQ(check.shift, (ScheduleShift{1, 0, 0}));
    EXPECT_EQ(check.possible, 1U);
    EXPECT_EQ(check.header_residual, std::nullopt);
}

// The tile of 16 x 16 pixels is read by 68 or 69 pixels a slot, so some shifts of slots contradict
// the numbers of samples. What the chip ran instead stays in the dark.
TEST(ScheduleCheckTest, InTheDarkOnlyTheNumbersOfSamplesTell) {
    const ExposureSchedule schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    const FluxVideo dark = waves(0, 0);
    EXPECT_EQ(check_shifted(dark, schedule, {}).verdict, Verdict::kCannotTell);
    EXPECT_EQ(check_shifted(dark, schedule, {0, 3, 1}).verdict, Verdict::kCannotTell);
    EXPECT_EQ(check_shifted(dark, schedule, {1, 0, 0}).verdict, Verdict::kNoneFits);
}

TEST(ScheduleCheckTest, CannotTellWhereAllIsSaturatedOrTheRecordingIsShort) {
    const ExposureSchedule schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    EXPECT_EQ(check_shifted(waves(50, 0), schedule, {}).verdict, Verdict::kCannotTell);
    EXPECT_EQ(check_shifted(waves(0.3, 0.7, 10), schedule, {}).verdict, Verdict::kCannotTell);
}

// Exposures all alike, without a texture to tell pixels apart: no shift can be told from another.
TEST(ScheduleCheckTest, CannotTellShiftsThatLookAlike) {
    const ExposureSchedule staggered(1, 4, 4, {0, 1, 2, 3, 4},
                                     {{0, 15}, {1, 15}, {2, 15}, {3, 15}});
    EXPECT_EQ(check_shifted(waves(0.3, 0), staggered, {1, 0, 0}).verdict, Verdict::kCannotTell);
}

TEST(ScheduleCheckTest, SaysThatNoShiftFitsAnotherSchedule) {
    const FluxVideo video = waves(0.3, 0.7);
    Recorded recorded = record(video, random_schedule(48, 64, kPaperExposureSlots, 1));
    const TemporaryFolder folder;
    StreamWriter writer(folder / "clip.stipple", recorded.header);
    for (const SamplePacket& packet : recorded.packets) writer.write(packet);
    writer.finish();
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kAnySchedule);
    reader.use_schedule(random_schedule(48, 64, kPaperExposureSlots, 2));
    const ScheduleCheck check = check_schedule(reader);
    EXPECT_EQ(check.verdict, Verdict::kNoneFits);
    EXPECT_EQ(check.possible, 0U);
}

TEST(ScheduleCheckTest, GivesTheSameForAnyNumberOfThreads) {
    const ExposureSchedule schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    const auto residual = [&](int threads) {
        const ThreadLimit limit(threads);
        return check_shifted(waves(0.3, 0.7), schedule, {2, 3, 4}).best_residual;
    };
    EXPECT_EQ(residual(1), residual(2));
}

// Two pixels side by side, of which one exposes two slots and one one slot: (a, b) are rates.
TEST(ScheduleResidualTest, IsTheDifferenceOverTheSumAndTheNoise) {
    StreamHeader header{{1, 2, 1}, 5000, {}, {1, 2, 2, {0, 1, 2}, {{0, 3}, {1, 1}}}, {}, "", ""};
    header.calibration.gain_e_per_dn = 10;
    const std::vector<SamplePacket> packets{{1, 0, 1, 0, {100, 20}}};  // 1000 e in 2, 200 e in 1
    const ScheduleResidual residual = ResidualMeter(header, packets).residual({}, 1);
    const double constant = 100 + 100.0 / 12;  // read noise 10 e, rounding
    const double noise = std::sqrt((1000 + constant) / 4 + 200 + constant);
    EXPECT_NEAR(*residual.mean(), 300 / (500 + 200 + 3 * noise), 1e-6);
}

}  // namespace
}  // namespace stipple
