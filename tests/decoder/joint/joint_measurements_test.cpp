#include "decoder/joint/joint_measurements.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/index.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/light_warp.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 14, .cols = 19, .planes = 1};
constexpr int kSlots = 24;

/// The video as a sensor sees it, from a slot on.
FluxVideo seen(const FluxVideo& video, const SensorView& view) {
    FluxVideo result(video.slots() - static_cast<int>(view.phase_slots), video.shape());
    LightWarp warp(view.from_reference, video.shape());
    for (int slot = 0; slot < result.slots(); ++slot) {
        const auto frame = warp(video.frame(slot + static_cast<int>(view.phase_slots)));
        std::ranges::copy(frame, result.frame(slot).begin());
    }
    return result;
}

/// Checks each exposure of the second sensor against the light of the first one's pixels.
void expect_light_of_video(const Measurements& m, const FluxVideo& video) {
    const std::size_t sites = m.shape.sites();
    std::size_t samples = 0;
    for (std::size_t site = 0; site < sites; ++site) {
        double light = 0;
        for (int slot = 0; slot < m.slots; ++slot) {
            const std::size_t i = index(slot) * sites + site;
            if ((m.state[i] & Measurements::kFirst) != 0) light = 0;
            if ((m.state[i] & Measurements::kOpen) != 0)
                light += static_cast<double>(video.data()[i]);
            if ((m.state[i] & Measurements::kLast) == 0) continue;
            ++samples;
            EXPECT_NEAR(m.sum[i], light, 2e-4);  // a DN is 1 / 20000
        }
    }
    EXPECT_GT(samples, 40U);
}

SensorParams exact_sensor() {
    return {.full_scale_e = 16000,
            .full_well_e = 16000,
            .read_noise_e = 0,
            .shot_noise = false,
            .bit_depth = 16};
}

TEST(JointMeasurementsTest, WholePixelsAndSlotsAreExact) {
    const FluxVideo video = random_video(kSlots, kShape, 1);
    const SensorView view{Homography::shift({.row = 3, .col = -4}), 5};
    const Recorded first = record(video, gapped_schedule(5, 7, 31, 4), exact_sensor());
    const Recorded second = record(seen(video, view), gapped_schedule(6, 5, 23, 3), exact_sensor());
    const SensorSamples sensors[] = {{first.header, first.packets, {}},
                                     {second.header, second.packets, view}};
    const Measurements m = collect_joint(sensors, whole(video));
    ASSERT_EQ(m.others.size(), 1U);
    expect_light_of_video(m.others[0], video);
    const auto open = [&](int slot, int row, int col) {
        return m.others[0].state[index(slot) * kShape.pixels() + row_major(row, col, 19)] != 0;
    };
    for (int slot = 0; slot < kSlots; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                if (slot < 5 || row + 3 >= kShape.rows || col < 4) {
                    EXPECT_FALSE(open(slot, row, col)) << slot << ' ' << row << ' ' << col;
                }
}

TEST(JointMeasurementsTest, AWindowHasTheSamplesOfTheWhole) {
    const FluxVideo video = random_video(kSlots, kShape, 2);
    const SensorView view{Homography({0.97, 0.1, 1.2, -0.08, 1.01, 0.4, 1e-3, -5e-4, 1}), 2};
    const Recorded first = record(video, gapped_schedule(5, 7, 31, 4));
    const Recorded second = record(seen(video, view), gapped_schedule(6, 5, 23, 3));
    const SensorSamples sensors[] = {{first.header, first.packets, {}},
                                     {second.header, second.packets, view}};
    const Measurements all = collect_joint(sensors, whole(video));
    const VideoWindow window{.first_slot = 0,
                             .slots = kSlots,
                             .first_row = 4,
                             .first_col = 6,
                             .shape = {.rows = 7, .cols = 9, .planes = 1}};
    const Measurements part = collect_joint(sensors, window);
    ASSERT_EQ(part.others.size(), 1U);
    for (int slot = 0; slot < kSlots; ++slot)
        for (int row = 0; row < 7; ++row)
            for (int col = 0; col < 9; ++col) {
                const auto i = index(slot) * 63 + row_major(row, col, 9);
                const auto k = index(slot) * kShape.pixels() + row_major(row + 4, col + 6, 19);
                ASSERT_EQ(part.others[0].state[i], all.others[0].state[k]);
                ASSERT_EQ(part.others[0].sum[i], all.others[0].sum[k]);
                ASSERT_EQ(part.others[0].variance[i], all.others[0].variance[k]);
            }
}

TEST(JointMeasurementsTest, EqualSensorsBecomeOneWithTheirLight) {
    const FluxVideo video = random_video(kSlots, kShape, 3);
    const SensorParams half{.photons_per_unit = 500};
    const ExposureSchedule schedule = gapped_schedule(5, 7, 31, 4);
    const Recorded first = record(video, schedule, half, 1);
    const Recorded second = record(video, schedule, half, 2);
    const SensorSamples sensors[] = {{first.header, first.packets, {}},
                                     {second.header, second.packets, {}}};
    EXPECT_TRUE(collect_joint(sensors, whole(video)).others.empty());
    const Calibration joint = joint_calibration(sensors, 0);
    EXPECT_DOUBLE_EQ(joint.electrons_per_unit, 1000);
    // Two readings with 10 electrons, and the rounding of each.
    const auto one = static_cast<double>(SampleNoise(first.header.calibration).variance(0));
    EXPECT_NEAR(SampleNoise(joint).variance(0), one / 2, 1e-6 * one);
}

}  // namespace
}  // namespace stipple
