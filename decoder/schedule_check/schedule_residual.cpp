#include "decoder/schedule_check/schedule_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"

namespace stipple {
namespace {

constexpr std::int64_t kMostSlotsApart = 8;  ///< of a pair
constexpr float kSaturated = std::numeric_limits<float>::max();

/// Samples of one row that are due under a shifted schedule.
std::size_t count_shifted(const StreamHeader& header, const ScheduleShift& shift, std::int64_t slot,
                          int row) {
    const ExposureSchedule& schedule = header.schedule;
    const auto phase = static_cast<int>((slot + shift.slots) % schedule.period_slots());
    const auto due = schedule.due(phase, (row + shift.rows) % schedule.tile_rows());
    const auto below = [&](int col) {
        const auto end = std::ranges::partition_point(
            due, [col](const DuePixel& pixel) { return pixel.col < col; });
        return static_cast<std::size_t>(end - due.begin());
    };
    const int tile_cols = schedule.tile_cols();
    const int rest = header.shape.cols % tile_cols;
    const int end = shift.cols + rest;  // of the tile's columns that come once more
    std::size_t count = index(header.shape.cols / tile_cols) * due.size();
    count += below(std::min(end, tile_cols)) - below(shift.cols);
    if (end > tile_cols) count += below(end - tile_cols);
    return count;
}

/// About `count` of `rows` rows, in bands of some rows spread evenly: the number of each among
/// those taken, or -1.
std::vector<int> rows_spread(int rows, int count) {
    constexpr int kBandRows = 4;
    std::vector<int> numbers(index(rows), -1);
    const int bands = std::max(count / kBandRows, 1);
    int taken = 0;
    for (int row = 0; row < rows; ++row) {
        const int band = static_cast<int>(std::int64_t{row} * bands / rows);
        const int middle = rows * (2 * band + 1) / (2 * bands);
        if (count >= rows || std::abs(2 * (row - middle) + 1) <= kBandRows)
            numbers[index(row)] = taken++;
    }
    return numbers;
}

}  // namespace

std::optional<double> ScheduleResidual::mean() const {
    double all = 0;
    double count = 0;
    for (std::size_t i = 0; i < kParts; ++i) {
        all += sum[i];
        count += weight[i];
    }
    if (count == 0) return std::nullopt;
    return all / count;
}

double standard_errors_between(const ScheduleResidual& better, const ScheduleResidual& worse) {
    double n = 0;
    double mean = 0;
    double squares = 0;  // Welford
    for (std::size_t i = 0; i < ScheduleResidual::kParts; ++i) {
        if (better.weight[i] == 0 || worse.weight[i] == 0) continue;
        const double d = worse.sum[i] / worse.weight[i] - better.sum[i] / better.weight[i];
        ++n;
        const double step = d - mean;
        mean += step / n;
        squares += step * (d - mean);
    }
    if (n < 2 || mean == 0) return 0;
    constexpr double kTiny = 1e-12;  // exact noise-free data have no spread
    return mean / std::max(std::sqrt(squares / (n - 1) / n), kTiny);
}

ResidualMeter::ResidualMeter(const StreamHeader& header, std::span<const SamplePacket> packets)
    : header_(header), packets_(packets), responses_(header.calibration) {}

ResidualMeter::Rate ResidualMeter::rate_of(int row, int col, std::uint16_t dn, int slots) const {
    const PixelResponse& response = responses_.at(row, col);
    if (response.saturated(dn)) return {.light = kSaturated};
    const float light = response.light(dn, slots);
    const auto n = static_cast<float>(slots);
    return {light / n, response.noise().variance(light) / (n * n)};
}

void ResidualMeter::add_pair(const Rate& a, const Rate& b, std::size_t part,
                             ScheduleResidual& result) {
    const float light = std::abs(a.light) + std::abs(b.light);
    if (light == 0 || b.slot < a.slot - kMostSlotsApart) return;
    const float size = light + 3 * std::sqrt(a.variance + b.variance);
    const float weight = light / size;
    result.weight[part] += static_cast<double>(weight);
    result.sum[part] += static_cast<double>(weight * std::abs(a.light - b.light) / size);
}

ScheduleResidual ResidualMeter::residual(const ScheduleShift& shift, int rows) const {
    const std::vector<int> numbers = rows_spread(header_.shape.rows, rows);
    const auto cols = index(header_.shape.cols);
    const int apart = header_.cfa == ColourFilter::kNone ? 1 : 2;
    std::vector<Rate> latest(index(*std::ranges::max_element(numbers) + 1) * cols);
    ScheduleResidual result;
    for (const SamplePacket& packet : packets_) {
        const std::uint16_t* dn = packet.dn.data();
        const int end = packet.dn.empty() ? 0 : packet.first_row + packet.rows;
        for (int row = packet.first_row; row < end; ++row) {
            const int number = numbers[index(row)];
            if (number < 0) {
                dn += count_shifted(header_, shift, packet.slot, row) * planes();
                continue;
            }
            const int above = row < apart ? -1 : numbers[index(row - apart)];
            const auto take = [&](int col, const DuePixel& pixel) {
                const std::size_t at = index(number) * cols + index(col);
                Rate& here = latest[at];
                here = rate_of(row, col, *dn, pixel.light_slots);
                dn += planes();
                if (here.light == kSaturated) return;
                here.slot = packet.slot;
                const std::size_t part = at * ScheduleResidual::kParts / latest.size();
                if (col >= apart) add_pair(here, latest[at - index(apart)], part, result);
                if (above >= 0)
                    add_pair(here, latest[index(above) * cols + index(col)], part, result);
            };
            visit_due_shifted(header_.schedule, shift, {packet.slot, row, header_.shape.cols},
                              take);
        }
    }
    return result;
}

bool ResidualMeter::fits(const ScheduleShift& shift) const {
    return std::ranges::all_of(packets_, [&](const SamplePacket& packet) {
        if ((packet.flags & SamplePacket::kDropped) != 0) return true;
        std::size_t due = 0;
        for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
            due += count_shifted(header_, shift, packet.slot, row);
        return due * planes() == packet.dn.size();
    });
}

}  // namespace stipple
