#include "decoder/measurements.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 11, .cols = 14, .planes = 3};

std::size_t voxel(FrameShape shape, std::int64_t slot, int plane, int row, int col) {
    return (((static_cast<std::size_t>(slot) * static_cast<std::size_t>(shape.planes) +
              static_cast<std::size_t>(plane)) *
                 static_cast<std::size_t>(shape.rows) +
             static_cast<std::size_t>(row)) *
            static_cast<std::size_t>(shape.cols)) +
           static_cast<std::size_t>(col);
}

/// One pixel, exposures of one slot, one packet with this DN.
Measurements measure_one(const Calibration& calibration, std::uint16_t dn) {
    const StreamHeader header{{1, 1, 1}, 5000, calibration, {1, 1, 1, {0, 1}, {{0, 1}}},
                              {},        "",   ""};
    return collect_measurements(header, std::vector<SamplePacket>{{0, 0, 1, 0, {dn}}},
                                {0, 1, 0, 0, {1, 1, 1}});
}

TEST(MeasurementsTest, TurnDnIntoLightByTheCalibration) {
    const Calibration calibration{.bit_depth = 10,
                                  .rounding = Rounding::kNearest,
                                  .black_level_dn = 64,
                                  .gain_e_per_dn = 5,
                                  .read_noise_e = 3,
                                  .full_well_e = 1e6,
                                  .electrons_per_unit = 200};
    const Measurements m = measure_one(calibration, 264);
    EXPECT_FLOAT_EQ(m.sum[0], (264 - 64) * 5 / 200.0F);
    // (r X + sigma^2) / r^2 + q^2 / 12 with r = 200, X = 5, sigma = 3, q = 5 / 200.
    EXPECT_FLOAT_EQ(m.variance[0], (200 * 5.0F + 9) / 40000 + (5 / 200.0F) * (5 / 200.0F) / 12);
    EXPECT_EQ(m.state[0], Measurements::kOpen | Measurements::kFirst | Measurements::kLast);
}

TEST(MeasurementsTest, PlaceADnOfAFlooringConverterAtTheMiddleOfItsLevel) {
    Calibration calibration;
    calibration.rounding = Rounding::kFloor;
    calibration.gain_e_per_dn = 10;
    EXPECT_FLOAT_EQ(measure_one(calibration, 7).sum[0], 7.5F * 10 / 1000);
}

TEST(MeasurementsTest, AreSaturatedAtFullScaleAndAtTheFullWell) {
    const auto saturated = [](const Calibration& calibration, std::uint16_t dn) {
        return (measure_one(calibration, dn).state[0] & Measurements::kSaturated) != 0;
    };
    Calibration calibration;
    EXPECT_TRUE(saturated(calibration, 255));
    EXPECT_FALSE(saturated(calibration, 254));
    // A well of 1000 e, 127.5 DN of 2000 / 255 e; read noise of 10 e and rounding come to 1.31 DN,
    // and five times that below the well is 120.96.
    calibration.full_well_e = 1000;
    EXPECT_TRUE(saturated(calibration, 121));
    EXPECT_FALSE(saturated(calibration, 120));
}

/// Every voxel's state and sum against the list of exposures, in a window that cuts the recording.
void expect_definition(const ExposureSchedule& schedule, const VideoWindow& window) {
    const FluxVideo video = random_video(40, kShape, 5);
    const Recorded recorded = record(video, schedule);
    const Measurements m = collect_measurements(recorded.header, recorded.packets, window);
    std::vector<std::uint8_t> state(m.voxels(), 0);
    std::size_t exposures = 0;
    for (int row = 0; row < window.shape.rows; ++row)
        for (int col = 0; col < window.shape.cols; ++col)
            for (const TakenExposure& taken :
                 taken_exposures(schedule, row + window.first_row, col + window.first_col, 40)) {
                const std::int64_t first = taken.begin_slot - window.first_slot;
                const std::int64_t last = taken.last_slot() - window.first_slot;
                if (first < 0 || last >= window.slots) continue;
                ++exposures;
                for (int plane = 0; plane < kShape.planes; ++plane) {
                    const auto at = [&](std::int64_t slot) -> std::uint8_t& {
                        return state[voxel(window.shape, slot, plane, row, col)];
                    };
                    for (int i = 0; i < taken.exposure.span_slots(); ++i)
                        if ((taken.exposure.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
                            at(first + i) |= Measurements::kOpen;
                    at(first) |= Measurements::kFirst;
                    at(last) |= Measurements::kLast;
                }
            }
    ASSERT_GT(exposures, 50U);
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        constexpr int kNotListed =
            Measurements::kSaturated | Measurements::kSecond | Measurements::kZero;
        ASSERT_EQ(m.state[i] & ~kNotListed, state[i]) << "voxel " << i;
        if ((state[i] & Measurements::kLast) == 0) {
            ASSERT_EQ(m.sum[i], 0);
            ASSERT_EQ(m.variance[i], 0);
        }
    }
}

TEST(MeasurementsTest, HoldTheExposuresThatLieWhollyInTheWindow) {
    const ExposureSchedule random = random_schedule(11, 14, kPaperExposureSlots, 3);
    expect_definition(random, {0, 40, 0, 0, kShape});
    expect_definition(random, {9, 24, 2, 5, {7, 6, 3}});
}

TEST(MeasurementsTest, KnowTheClosedSlotsOfAnExposure) {
    const ExposureSchedule gapped = gapped_schedule(4, 5, 23, 8);
    expect_definition(gapped, {0, 40, 0, 0, kShape});
    expect_definition(gapped, {5, 30, 1, 3, {9, 8, 3}});
}

TEST(MeasurementsTest, LeaveVoxelsOfMissingAndDroppedSamplesUnobserved) {
    const FluxVideo video = random_video(24, kShape, 5);
    Recorded recorded = record(video, random_schedule(11, 14, kPaperExposureSlots, 3));
    const Measurements all = collect_measurements(recorded.header, recorded.packets, whole(video));
    recorded.packets[10].dn.clear();
    recorded.packets[10].flags = SamplePacket::kDropped;
    recorded.packets.erase(recorded.packets.begin() + 17);
    const Measurements some = collect_measurements(recorded.header, recorded.packets, whole(video));
    const std::size_t sites = kShape.sites();
    for (std::size_t i = 0; i < all.voxels(); ++i) {
        std::size_t last = i;  // of the exposure that voxel i is in, in the full recording
        while (last < all.voxels() && (all.state[last] & Measurements::kLast) == 0) last += sites;
        const bool gone = last / sites == 10 || last / sites == 17;
        EXPECT_EQ(some.state[i], gone ? 0 : all.state[i]);
        EXPECT_EQ(some.sum[i], gone ? 0 : all.sum[i]);
    }
}

TEST(MeasurementsTest, KeepExposuresThatInterleaveInChainsOfTheirOwn) {
    const FluxVideo video = random_video(40, kShape, 5);
    for (const auto& schedule : {interleaved_schedule(4, 5, 6, 8), alternating_schedule()}) {
        expect_definition(schedule, {0, 40, 0, 0, kShape});
        expect_definition(schedule, {5, 30, 1, 3, {9, 8, 3}});
        const Measurements m = measure(video, schedule);
        EXPECT_TRUE(m.interleaved);
        for (std::size_t site = 0; site < kShape.sites(); ++site)
            for (const std::uint8_t chain : {std::uint8_t{0}, Measurements::kSecond}) {
                bool under_way = false;  // first and last voxels take turns
                for (std::size_t i = site; i < m.voxels(); i += kShape.sites()) {
                    if ((m.state[i] & Measurements::kOpen) == 0) continue;
                    if ((m.state[i] & Measurements::kSecond) != chain) continue;
                    ASSERT_EQ((m.state[i] & Measurements::kFirst) != 0, !under_way);
                    under_way = (m.state[i] & Measurements::kLast) == 0;
                }
                ASSERT_FALSE(under_way);
            }
    }
}

TEST(MeasurementsTest, RefuseThreeExposuresAtOnce) {
    const ExposureSchedule three(1, 1, 9, {0, 3}, {{0, 0b1001}, {1, 0b1001}, {2, 0b1001}});
    const StreamHeader header{{1, 1, 1}, 5000, {}, three, {}, "", ""};
    EXPECT_THROW(static_cast<void>(collect_measurements(header, {}, {0, 18, 0, 0, {1, 1, 1}})),
                 InputError);
}

}  // namespace
}  // namespace stipple
