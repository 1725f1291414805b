#include "readout/timing/readout_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"
#include "core/geometry.h"

namespace stipple {
namespace {

void require(bool holds, std::string_view sensor, const std::string& constraint) {
    if (!holds) throw InputError(fmt::format("sensor \"{}\": timing", sensor), constraint);
}

bool rises(const std::vector<int>& values) {
    return std::ranges::adjacent_find(values, std::greater_equal<>{}) == values.end();
}

void check_array(const ReadoutTiming& timing, std::string_view sensor) {
    const ColumnAddressing& addressing = timing.addressing;
    require(timing.rows >= 1 && timing.rows <= kMaxFrameSide && timing.cols >= 1 &&
                timing.cols <= kMaxFrameSide,
            sensor,
            fmt::format("an array of {} x {} pixels (cols x rows); both are 1..{}", timing.cols,
                        timing.rows, kMaxFrameSide));
    require(addressing.channels >= 1 && timing.cols % addressing.channels == 0, sensor,
            fmt::format("{} channels do not divide {} columns evenly", addressing.channels,
                        timing.cols));
    require(timing.columns_per_adc >= 1 && timing.cols % timing.columns_per_adc == 0, sensor,
            fmt::format("{} columns_per_adc do not divide {} columns evenly",
                        timing.columns_per_adc, timing.cols));
    require(addressing.group_cols >= 1 && addressing.group_cols <= timing.cols &&
                addressing.group_rows >= 1 && addressing.group_rows <= timing.rows,
            sensor,
            fmt::format("a group of {} columns x {} rows does not fit {} x {} pixels",
                        addressing.group_cols, addressing.group_rows, timing.cols, timing.rows));
}

void check_row_table(const ReadoutTiming& timing, std::string_view sensor) {
    const auto& widths = timing.row_table_cols;
    const auto& clocks = timing.row_table_clocks;
    require(widths.size() == clocks.size(), sensor,
            fmt::format("row_table_cols has {} entries, row_table_clocks {}", widths.size(),
                        clocks.size()));
    if (widths.empty()) return;
    require(widths.front() >= 1 && rises(widths), sensor, "row_table_cols does not rise from 1 on");
    require(clocks.front() >= 1 && std::ranges::is_sorted(clocks), sensor,
            "row_table_clocks falls, or begins below 1");
    require(widths.back() >= timing.cols, sensor,
            fmt::format("row_table_cols ends at {}, below {} columns", widths.back(), timing.cols));
}

void check_clocks(const ReadoutTiming& timing, std::string_view sensor) {
    require(timing.clock_hz >= 1, sensor, "clock_hz is 0");
    for (const std::int64_t clocks :
         {std::int64_t{timing.clocks_per_column}, std::int64_t{timing.io_clocks},
          std::int64_t{timing.rot_clocks}, std::int64_t{timing.adc_clocks},
          std::int64_t{timing.blanking_clocks}, std::int64_t{timing.skip_row_clocks},
          std::int64_t{timing.dark_rows}, std::int64_t{timing.overhead_rows},
          timing.overhead_clocks, timing.code_load_clocks})
        require(clocks >= 0, sensor, fmt::format("{} clocks; none can be negative", clocks));
    require((timing.link_lanes == 0) == (timing.link_bps == 0), sensor,
            fmt::format("{} link_lanes at {} link_bps; give both or none", timing.link_lanes,
                        timing.link_bps));
    const int all = timing.cols / timing.addressing.channels;
    require(transfer_clocks(timing, all) >= 1 && transfer_clocks(timing, 1) >= 1, sensor,
            "the transfer of a row takes 0 clocks; set clocks_per_column or io_clocks");
    require(timing.settle_clocks.empty() ||
                (timing.settle_clocks.front() >= 0 && rises(timing.settle_clocks)),
            sensor, "settle_clocks does not rise from 0 on");
}

/// So that no sum of clocks of a recording overflows.
void check_length(const ReadoutTiming& timing, std::string_view sensor) {
    const int longest_settle = timing.settle_clocks.empty() ? 0 : timing.settle_clocks.back();
    const std::int64_t row = convert_clocks(timing, longest_settle, timing.columns_per_adc) +
                             transfer_clocks(timing, timing.cols / timing.addressing.channels) +
                             2 * std::int64_t{timing.blanking_clocks};
    const std::int64_t rows =
        std::int64_t{timing.rows} + timing.dark_rows + timing.overhead_rows + 1;
    require(static_cast<double>(row) * static_cast<double>(rows) <=
                static_cast<double>(kMaxReadoutClocks),
            sensor,
            fmt::format("{} rows of up to {} clocks exceed {} clocks a readout", rows, row,
                        kMaxReadoutClocks));
}

}  // namespace

void validate(const ReadoutTiming& timing, std::string_view sensor) {
    check_array(timing, sensor);
    check_row_table(timing, sensor);
    check_clocks(timing, sensor);
    check_length(timing, sensor);
}

int settle_clocks(const ReadoutTiming& timing, int channel_columns) noexcept {
    const auto& choices = timing.settle_clocks;
    if (choices.empty()) return 0;
    const auto above = std::ranges::upper_bound(choices, channel_columns + timing.settle_margin);
    return above == choices.begin() ? choices.front() : *(above - 1);
}

std::int64_t transfer_clocks(const ReadoutTiming& timing, int channel_columns) noexcept {
    const int channels = timing.addressing.channels;
    if (timing.row_timing == RowTiming::kFullWidth) channel_columns = timing.cols / channels;
    const std::int64_t columns = std::int64_t{channel_columns} * channels;
    if (!timing.row_table_cols.empty()) {
        const auto width = std::ranges::lower_bound(timing.row_table_cols, columns);
        return timing
            .row_table_clocks[static_cast<std::size_t>(width - timing.row_table_cols.begin())];
    }
    std::int64_t clocks = std::int64_t{channel_columns} * timing.clocks_per_column;
    if (timing.link_lanes > 0) {
        const std::int64_t bits_clocks = columns * timing.bits_per_sample * timing.clock_hz;
        const std::int64_t link_bps = timing.link_lanes * timing.link_bps;
        clocks = std::max(clocks, (bits_clocks + link_bps - 1) / link_bps);
    }
    return clocks + timing.io_clocks;
}

std::int64_t convert_clocks(const ReadoutTiming& timing, int settle, int conversions) noexcept {
    return std::int64_t{timing.rot_clocks} + settle + std::int64_t{conversions} * timing.adc_clocks;
}

std::int64_t code_load_clocks(const ReadoutTiming& timing, int rows) noexcept {
    return (timing.code_load_clocks * rows + timing.rows - 1) / timing.rows;
}

double conversion_energy_pj(const ReadoutTiming& timing) noexcept {
    return std::ldexp(timing.conversion_pj, timing.bits_per_sample - kConversionBits);
}

std::int64_t row_clocks(const ReadoutTiming& timing, std::int64_t convert,
                        std::int64_t transfer) noexcept {
    const std::int64_t busy = timing.row_timing == RowTiming::kSequential
                                  ? convert + transfer
                                  : std::max(convert, transfer);
    return busy + timing.blanking_clocks;
}

}  // namespace stipple
