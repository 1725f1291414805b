#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "core/exposure_schedule.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"

namespace stipple {

/// Draws whole numbers, the same ones everywhere.
class Draw {
  public:
    explicit Draw(std::uint32_t seed) : engine_(seed) {}
    int operator()(int least, int most) {
        return least + static_cast<int>(engine_() % static_cast<std::uint32_t>(most - least + 1));
    }

  private:
    std::mt19937 engine_;
};

/// A small sensor of any row timing, addressing and ADC sharing, with clocks that often tie or are
/// 0.
inline ReadoutTiming random_timing(Draw& draw) {
    ReadoutTiming timing;
    timing.clock_hz = 1'000'000;
    timing.row_timing = static_cast<RowTiming>(draw(0, 2));
    timing.rows = draw(1, 9);
    timing.addressing.kind = static_cast<ColumnAddressing::Kind>(draw(0, 1));
    timing.addressing.channels = draw(1, 4);
    timing.columns_per_adc = draw(1, 3);
    timing.cols = timing.addressing.channels * timing.columns_per_adc * draw(1, 4);
    timing.addressing.group_cols = draw(1, timing.cols < 4 ? timing.cols : 4);
    timing.addressing.group_rows = draw(1, timing.rows < 3 ? timing.rows : 3);
    timing.adc_skip = draw(0, 1) == 1;
    timing.clocks_per_column = draw(1, 3);
    timing.io_clocks = draw(0, 2);
    if (draw(0, 3) == 0) {
        timing.row_table_cols = {timing.cols, timing.cols + 3};
        if (timing.cols > 2) timing.row_table_cols.insert(timing.row_table_cols.begin(), 2);
        for (int i = 0; i < static_cast<int>(timing.row_table_cols.size()); ++i)
            timing.row_table_clocks.push_back(4 * (i + 1));
    }
    if (draw(0, 3) == 0) {
        timing.link_lanes = draw(1, 2);
        timing.link_bps = draw(2'000'000, 20'000'000);
    }
    timing.rot_clocks = draw(0, 3);
    if (draw(0, 1) == 0) timing.settle_clocks = {draw(0, 2), draw(3, 5), draw(6, 9)};
    timing.settle_margin = draw(-2, 5);
    timing.adc_clocks = draw(0, 5);
    timing.blanking_clocks = draw(0, 1) * draw(0, 3);
    timing.skip_row_clocks = draw(0, 1) * draw(0, 4);
    timing.dark_rows = draw(0, 1) * draw(0, 2);
    timing.overhead_rows = draw(0, 1) * draw(0, 3);
    timing.overhead_clocks = draw(0, 20);
    timing.code_load_clocks = draw(0, 1) * draw(0, 200);
    return timing;
}

/// A schedule of a small tile: frames, exposures of several lengths, gaps within them or between.
inline ExposureSchedule random_frames(Draw& draw) {
    const int rows = draw(1, 4), cols = draw(1, 4), period = draw(1, 12);
    const int pixels = rows * cols, own = draw(0, 2) == 0 ? 1 : pixels;
    std::vector<std::vector<Exposure>> drawn(static_cast<std::size_t>(own));
    for (auto& exposures : drawn)
        for (int slot = 0; slot < period;) {
            const int span = draw(1, std::min(period - slot, 8));
            const auto mask = static_cast<std::uint64_t>(draw(0, 255)) | 1U;
            if (draw(0, 4) > 0)
                exposures.push_back({static_cast<std::uint32_t>(slot),
                                     (mask & open_without_gap(span)) |
                                         std::uint64_t{1} << static_cast<unsigned>(span - 1)});
            slot += span + draw(0, 1) * draw(0, 3);
        }
    if (drawn.front().empty()) drawn.front().push_back({0, 1});
    std::vector<Exposure> exposures;
    std::vector<std::uint32_t> first{0};
    for (int pixel = 0; pixel < pixels; ++pixel) {
        const auto& of_pixel = drawn[static_cast<std::size_t>(pixel % own)];
        exposures.insert(exposures.end(), of_pixel.begin(), of_pixel.end());
        first.push_back(static_cast<std::uint32_t>(exposures.size()));
    }
    return ExposureSchedule(rows, cols, period, first, exposures);
}

/// Rows of a sensor with loads that no schedule has made, some rows left out.
inline std::vector<RowLoad> random_loads(const ReadoutTiming& timing, Draw& draw) {
    std::vector<RowLoad> loads;
    for (int row = -timing.dark_rows; row < timing.rows; ++row) {
        if (draw(0, 2) == 0) continue;
        loads.push_back({.row = row,
                         .due = draw(0, timing.cols),
                         .columns = draw(1, timing.cols),
                         .channel_columns = draw(1, timing.cols / timing.addressing.channels),
                         .conversions = draw(1, timing.columns_per_adc)});
    }
    return loads;
}

}  // namespace stipple
