#include "decoder/portz2013/exposure_table.h"

#include <gtest/gtest.h>

#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

TEST(ExposureTableTest, FindsForEachOpenSlotTheSampleThatItIsIn) {
    const FrameShape shape{5, 7, 2};
    const int slots = 40;
    for (const ExposureSchedule& schedule :
         {gapped_schedule(5, 7, 31, 4), interleaved_schedule(5, 7, 9, 4),
          random_schedule(5, 7, kPaperExposureSlots, 2)}) {
        const Measurements m = measure(random_video(slots, shape, 1), schedule);
        const ExposureTable table(m);
        std::size_t open = 0;
        for (const std::uint8_t state : m.state) open += state & Measurements::kOpen;
        std::size_t found = 0;
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                for (const TakenExposure& taken : taken_exposures(schedule, row, col, slots)) {
                    if (taken.last_slot() >= slots) continue;
                    const auto begin = static_cast<int>(taken.begin_slot);
                    for (int k = 0; k < taken.exposure.span_slots(); ++k) {
                        if ((taken.exposure.open_slots >> static_cast<unsigned>(k) & 1U) == 0)
                            continue;
                        const auto site =
                            shape.pixels() + static_cast<std::size_t>(row * shape.cols + col);
                        const TimedSample* sample = table.at(site, begin + k);
                        ASSERT_NE(sample, nullptr);
                        EXPECT_EQ(sample->first_slot, begin);
                        EXPECT_EQ(sample->open_slots, taken.exposure.open_slots);
                        EXPECT_EQ(sample->span_slots, taken.exposure.span_slots());
                        const auto last = static_cast<std::size_t>(taken.last_slot());
                        EXPECT_EQ(sample->light, m.sum[last * shape.sites() + site]);
                        ++found;
                    }
                }
        EXPECT_EQ(2 * found, open) << "both planes";
    }
}

TEST(ExposureTableTest, BitsMoveByTheDistanceOfTheirFirstSlots) {
    EXPECT_EQ(shift_mask(0b1101, 2), 0b11U);
    EXPECT_EQ(shift_mask(0b1101, -1), 0b11010U);
    EXPECT_EQ(shift_mask(~std::uint64_t{0}, 64), 0U);
    EXPECT_EQ(shift_mask(~std::uint64_t{0}, -64), 0U);
    EXPECT_EQ(lowest_bits(0), 0U);
    EXPECT_EQ(lowest_bits(3), 7U);
    EXPECT_EQ(lowest_bits(64), ~std::uint64_t{0});
}

}  // namespace
}  // namespace stipple
