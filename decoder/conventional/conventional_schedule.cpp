#include "decoder/conventional/conventional_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::size_t kMaxExposureTimes = 4;  ///< each takes memory
constexpr double kSameWeight = 1e-4;          ///< relative; weights of streams are floats

bool equally_long(std::span<const Exposure> exposures) {
    return std::ranges::all_of(exposures, [&](const Exposure& e) {
        return e.span_slots() == exposures.front().span_slots() &&
               e.light_slots() == exposures.front().light_slots();
    });
}

std::size_t exposure_times(std::span<const Exposure> exposures) {
    std::set<int> times;
    for (const Exposure& exposure : exposures) times.insert(exposure.light_slots());
    return times.size();
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

/// The exposures that all pixels of the tile share, none if nothing is read; nothing if they
/// differ.
std::optional<std::span<const Exposure>> common_exposures(const ExposureSchedule& schedule) {
    if (schedule.interleaved()) return {};
    std::span<const Exposure> shared;
    std::vector<double> shares;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            const std::span<const Exposure> own = schedule.exposures(row, col);
            if (own.empty()) continue;
            const bool first = shared.empty();
            if (first) shared = own;
            if (!first && !std::ranges::equal(own, shared)) return {};
            if (!schedule.weighted()) continue;
            if (first)
                shares = weight_shares(schedule, row, col);
            else if (!alike(shares, weight_shares(schedule, row, col)))
                return {};
        }
    return shared;
}

}  // namespace

bool conventional(const ExposureSchedule& schedule) {
    const auto shared = common_exposures(schedule);
    return shared && equally_long(*shared);
}

bool alternating(const ExposureSchedule& schedule) {
    const auto shared = common_exposures(schedule);
    const std::size_t times = shared ? exposure_times(*shared) : 0;
    return times >= 2 && times <= kMaxExposureTimes;
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

void require_alternating(const ExposureSchedule& schedule, std::string_view stream,
                         std::string_view method) {
    if (alternating(schedule)) return;
    throw InputError(stream,
                     fmt::format("the method {} merges frames of different exposure times: "
                                 "schedules whose pixels all have the same exposures, one after "
                                 "the other, of 2 to {} lengths, as alternating and dol; "
                                 "decode this stream by naive, fast or best",
                                 method, kMaxExposureTimes));
}

}  // namespace stipple
