#include "decoder/rivals/conventional_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

constexpr double kSameWeight = 1e-4;  ///< relative; weights of streams are floats

bool equally_long(std::span<const Exposure> exposures) {
    return std::ranges::all_of(exposures, [&](const Exposure& e) {
        return e.span_slots() == exposures.front().span_slots() &&
               e.light_slots() == exposures.front().light_slots();
    });
}

/// Weights of a tile pixel in all open slots of its exposures, as shares of their sum.
std::vector<double> weight_shares(const ExposureSchedule& schedule, int row, int col) {
    std::vector<double> shares;
    double sum = 0;
    for (int phase = 0; phase < schedule.period_slots(); ++phase) {
        shares.push_back(static_cast<double>(schedule.weight(phase, row, col)));
        sum += shares.back();
    }
    for (double& share : shares) share /= sum;
    return shares;
}

bool alike(const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(
        a, b, [](double x, double y) { return std::abs(x - y) <= kSameWeight * std::max(x, y); });
}

}  // namespace

bool conventional(const ExposureSchedule& schedule) {
    if (schedule.interleaved()) return false;
    std::span<const Exposure> shared;
    std::vector<double> shares;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            const std::span<const Exposure> own = schedule.exposures(row, col);
            if (own.empty()) continue;
            const bool first = shared.empty();
            if (first) shared = own;
            if (first ? !equally_long(own) : !std::ranges::equal(own, shared)) return false;
            if (!schedule.weighted()) continue;
            if (first)
                shares = weight_shares(schedule, row, col);
            else if (!alike(shares, weight_shares(schedule, row, col)))
                return false;
        }
    return true;
}

void require_conventional(const ExposureSchedule& schedule, std::string_view stream,
                          std::string_view method) {
    if (conventional(schedule)) return;
    throw InputError(stream,
                     fmt::format("the method {} takes the frames of a conventional camera: "
                                 "schedules whose pixels all have the same exposures, one after "
                                 "the other and of equal length, as full1x and full4x; decode this "
                                 "coded stream by naive, fast or best",
                                 method));
}

}  // namespace stipple
