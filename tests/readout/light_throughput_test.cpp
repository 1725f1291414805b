#include "readout/light_throughput.h"

#include <gtest/gtest.h>

#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 7, .cols = 9, .planes = 1};
const CalibrationTile kFilters{2, 3, {{1, 1}, {0.5, 1}, {0.25, 1}, {0.125, 1}, {1, 1}, {0.75, 1}}};

double transmittance(int row, int col) {
    return kFilters.pixels[static_cast<std::size_t>(row % 2 * 3 + col % 3)].responsivity;
}

/// Of all exposures that begin and end within the clip.
double light_by_exposure(const ExposureSchedule& schedule, std::int64_t slots) {
    double light = 0;
    for (int row = 0; row < kShape.rows; ++row)
        for (int col = 0; col < kShape.cols; ++col)
            for (const Exposure& exposure :
                 schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols()))
                for (std::int64_t begin = exposure.first_slot;
                     begin + exposure.span_slots() <= slots; begin += schedule.period_slots())
                    light += schedule.light_slots(row % schedule.tile_rows(),
                                                  col % schedule.tile_cols(), exposure) *
                             transmittance(row, col);
    return light;
}

TEST(LightThroughputTest, AClipHoldsTheExposuresThatBeginAndEndInIt) {
    for (const ExposureSchedule& schedule :
         {gapped_schedule(3, 5, 29, 1), interleaved_schedule(3, 5, 9, 1),
          random_schedule(7, 9, kPaperExposureSlots, 1),
          weighted_schedule(gapped_schedule(3, 5, 29, 1), 2)})
        for (const std::int64_t slots : {1, 7, 8, 30, 100})
            EXPECT_DOUBLE_EQ(light_due_in_clip(schedule, kFilters, kShape, slots),
                             light_by_exposure(schedule, slots))
                << slots;
}

TEST(LightThroughputTest, TheThroughputIsThatOfALongClip) {
    const auto schedule = gapped_schedule(3, 5, 29, 1);
    const std::int64_t slots = 29 * 10000;
    const double pixel_slots = static_cast<double>(slots) * static_cast<double>(kShape.pixels());
    // At most a period is lost at either end.
    EXPECT_NEAR(light_due_in_clip(schedule, kFilters, kShape, slots) / pixel_slots,
                light_throughput(schedule, kFilters, kShape), 2e-4);
    EXPECT_EQ(light_throughput(schedule, {}, kShape), schedule.light_throughput());
}

}  // namespace
}  // namespace stipple
