#pragma once

#include <gtest/gtest.h>

#include <set>

#include "core/exposure_schedule.h"

namespace stipple {

/// Expects that every pixel of the tile repeats exposures of 1, 2, 4 and 8 slots without gaps.
inline void expect_paper_exposures(const ExposureSchedule& schedule) {
    EXPECT_EQ(schedule.period_slots(), 15);
    EXPECT_TRUE(schedule.gapless());
    EXPECT_FALSE(schedule.interleaved());
    EXPECT_DOUBLE_EQ(1 / schedule.samples_per_pixel_slot(), 3.75);
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            std::multiset<int> spans;
            for (const Exposure& e : schedule.exposures(row, col)) spans.insert(e.span_slots());
            ASSERT_EQ(spans, (std::multiset<int>{1, 2, 4, 8}));
        }
}

}  // namespace stipple
