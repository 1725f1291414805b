#include "decoder/pixel_response.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

// Pixels of four gains, so that each has a limit of its own, under light that rises from slot to
// slot.
TEST(SaturatedSamplesTest, AreThoseThatMeasurementsTakeForBounds) {
    constexpr FrameShape kShape{.rows = 12, .cols = 10, .planes = 3};
    const SensorParams params{
        .full_scale_e = 4000,
        .full_well_e = 3000,
        .mode = SensorMode::kPhysical,
        .physical = {.map_rows = 2, .map_cols = 2, .gain_map = {1, 0.5, 2, 1.5}}};
    FluxVideo video(30, kShape);
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::fill(video.frame(slot), 0.1F * static_cast<float>(slot));
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    Recorded recorded = record(video, schedule, params);
    recorded.packets.push_back({30, 0, kShape.rows, SamplePacket::kDropped, {}});

    SaturatedSamples counted(recorded.header);
    std::uint64_t samples = 0;
    std::uint64_t zeros = 0;
    for (const SamplePacket& packet : recorded.packets) {
        counted.add(packet);
        samples += packet.dn.size();
        zeros += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 0));
    }
    const auto measured =
        collect_measurements(recorded.header, recorded.packets, {0, video.slots(), 0, 0, kShape});
    const auto bounds = std::ranges::count_if(
        measured.state, [](std::uint8_t state) { return (state & Measurements::kSaturated) != 0; });
    EXPECT_EQ(counted.samples(), samples);
    EXPECT_EQ(counted.saturated(), static_cast<std::uint64_t>(bounds));
    EXPECT_GT(bounds, 0);
    EXPECT_EQ(counted.zeros(), zeros);
    EXPECT_GT(zeros, 0U);
    EXPECT_LT(counted.saturated(), samples);
}

}  // namespace
}  // namespace stipple
