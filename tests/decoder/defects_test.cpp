#include "decoder/measurements.h"

#include <gtest/gtest.h>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{20, 24, 1};

/// Light between 0.2 and 0.4 everywhere.
FluxVideo lit() {
    FluxVideo video(40, kShape);
    const auto values = random_values(video.voxels(), 0.2F, 0.4F, 1);
    std::ranges::copy(values, video.data().begin());
    return video;
}

Recorded recorded(const FluxVideo& video) {
    return record(video, random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
}

/// Lets a pixel read `dn` for ever.
void stick(Recorded& recording, int stuck_row, int stuck_col, std::uint16_t value) {
    for (SamplePacket& packet : recording.packets) {
        auto dn = packet.dn.begin();
        for (int row = 0; row < kShape.rows; ++row)
            for_each_readout(recording.header.schedule, packet.slot, row, kShape.cols,
                             [&](int col, int) {
                                 if (row == stuck_row && col == stuck_col) *dn = value;
                                 ++dn;
                             });
    }
}

std::size_t defects(const Recorded& recording, Measurements* cleaned = nullptr) {
    FluxVideo video(static_cast<int>(recording.packets.size()), kShape);
    Measurements measurements =
        collect_measurements(recording.header, recording.packets, whole(video));
    const std::size_t found = mask_defects(measurements);
    if (cleaned != nullptr) *cleaned = measurements;
    return found;
}

bool observed(const Measurements& measurements, int row, int col) {
    for (int slot = 0; slot < measurements.slots; ++slot)
        if (measurements
                .state[static_cast<std::size_t>((slot * kShape.rows + row) * kShape.cols + col)] !=
            0)
            return true;
    return false;
}

TEST(DefectsTest, SoundPixelsStayAsTheyAre) {
    EXPECT_EQ(defects(recorded(lit())), 0U);
    EXPECT_EQ(defects(recorded(random_video(40, kShape, 1))), 0U);
}

TEST(DefectsTest, PixelsThatReadFullScaleOrNothingAreTakenOut) {
    Recorded recording = recorded(lit());
    stick(recording, 3, 4, 255);
    stick(recording, 10, 20, 0);
    stick(recording, 0, 0, 255);
    stick(recording, 19, 7, 0);
    Measurements cleaned;
    EXPECT_EQ(defects(recording, &cleaned), 4U);
    EXPECT_FALSE(observed(cleaned, 3, 4));
    EXPECT_FALSE(observed(cleaned, 10, 20));
    EXPECT_TRUE(observed(cleaned, 3, 5));
}

TEST(DefectsTest, ADeadColumnIsTakenOut) {
    Recorded recording = recorded(lit());
    for (int row = 0; row < kShape.rows; ++row) stick(recording, row, 9, 0);
    EXPECT_EQ(defects(recording), 20U);
}

TEST(DefectsTest, DarkAndBrightAreasAreNoDefects) {
    FluxVideo video = lit();
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int row = 5; row < 9; ++row)
            for (int col = 5; col < 9; ++col) {
                video.plane(slot, 0)(row, col) = 0;
                video.plane(slot, 0)(row, col + 8) = 10;
            }
    EXPECT_EQ(defects(recorded(video)), 0U);
}

TEST(DefectsTest, NothingIsFoundInTheDarkOrWhereAllIsSaturated) {
    for (const float light : {0.0F, 50.0F}) {
        FluxVideo video(40, kShape);
        std::ranges::fill(video.data(), light);
        EXPECT_EQ(defects(recorded(video)), 0U);
    }
}

}  // namespace
}  // namespace stipple
