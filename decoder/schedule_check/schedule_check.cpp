#include "decoder/schedule_check/schedule_check.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace stipple {
namespace {

int modulo(int value, int range) {
    return (value % range + range) % range;
}

constexpr std::int64_t kWindowSlots = 24;
constexpr std::size_t kMinPackets = 8;
constexpr int kWholeTile = 33;  ///< tiles up to this side are tried in all places
constexpr int kFarthest = 16;   ///< of larger ones
constexpr int kCoarsePixels = 4096;
constexpr int kFinePixels = 16384;
constexpr std::size_t kFinalists = 64;
constexpr double kClearlyBelow = 0.9;  ///< of the median
constexpr double kClearErrors = 5;     ///< standard errors

struct Candidate {
    ScheduleShift shift;  ///< normalised: not negative
    ScheduleResidual residual;
    double mean = 2;  ///< beyond any residual: no pairs
};

/// The number of the same remainder that is closest to 0.
int smallest(int value, int range) {
    return 2 * value > range ? value - range : value;
}

ScheduleShift smallest(const ScheduleShift& shift, const ExposureSchedule& schedule) {
    return {smallest(shift.slots, schedule.period_slots()),
            smallest(shift.rows, schedule.tile_rows()), smallest(shift.cols, schedule.tile_cols())};
}

/// Shifts along one side of the tile, normalised.
std::vector<int> places(int side) {
    std::vector<int> result;
    for (int i = 0; i < side; ++i)
        if (side <= kWholeTile || std::abs(smallest(i, side)) <= kFarthest) result.push_back(i);
    return result;
}

/// All shifts to try, the header's first, then from small to large: of equals the first wins.
std::vector<Candidate> all_shifts(const ExposureSchedule& schedule) {
    std::vector<Candidate> result;
    for (int slot = 0; slot < schedule.period_slots(); ++slot)
        for (const int row : places(schedule.tile_rows()))
            for (const int col : places(schedule.tile_cols()))
                result.push_back({.shift = {slot, row, col}, .residual = {}});
    std::ranges::stable_sort(result, {}, [&](const Candidate& candidate) {
        const ScheduleShift s = smallest(candidate.shift, schedule);
        return std::tuple(std::abs(s.slots) + std::abs(s.rows) + std::abs(s.cols),
                          std::abs(s.slots), s.slots < 0, s.rows < 0, s.cols < 0);
    });
    return result;
}

std::vector<SamplePacket> read_window(StreamReader& reader) {
    const std::int64_t begin = std::max(reader.header().schedule.longest_span_slots() - 1, 0);
    std::vector<SamplePacket> packets;
    SamplePacket packet;
    while (reader.next(packet) && packet.slot < begin + kWindowSlots)
        if (packet.slot >= begin) packets.push_back(packet);
    return packets;
}

void remove_impossible(std::vector<Candidate>& candidates, const ResidualMeter& meter) {
    std::vector<std::uint8_t> fits(candidates.size());
    parallel_for(0, static_cast<int>(candidates.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        fits[at] = meter.fits(candidates[at].shift) ? 1 : 0;
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (fits[i] != 0) candidates[kept++] = candidates[i];
    candidates.resize(kept);
}

void evaluate(std::vector<Candidate>& candidates, const ResidualMeter& meter, FrameShape shape,
              int pixels) {
    const int rows = std::max(pixels / shape.cols, 4);
    parallel_for(0, static_cast<int>(candidates.size()), [&](int i) {
        Candidate& candidate = candidates[static_cast<std::size_t>(i)];
        candidate.residual = meter.residual(candidate.shift, rows);
        candidate.mean = candidate.residual.mean().value_or(candidate.mean);
    });
}

double median_of(const std::vector<Candidate>& candidates) {
    std::vector<double> means;
    means.reserve(candidates.size());
    for (const Candidate& candidate : candidates) means.push_back(candidate.mean);
    const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
    std::nth_element(means.begin(), middle, means.end());
    return *middle;
}

/// Keeps the best ones, and the header's if it is there, in their order.
void keep_finalists(std::vector<Candidate>& candidates) {
    if (candidates.size() <= kFinalists) return;
    std::vector<double> means;
    means.reserve(candidates.size());
    for (const Candidate& candidate : candidates) means.push_back(candidate.mean);
    const auto last = means.begin() + kFinalists - 1;
    std::nth_element(means.begin(), last, means.end());
    const double limit = *last;
    std::erase_if(candidates, [&](const Candidate& candidate) {
        return candidate.mean > limit && candidate.shift != ScheduleShift{};
    });
}

ScheduleCheck::Verdict judge(const std::vector<Candidate>& finalists, const Candidate& best,
                             const Candidate* header, double median) {
    using enum ScheduleCheck::Verdict;
    // Where only one shift is possible, the numbers of samples alone have decided.
    const bool clear = finalists.size() == 1 || best.mean < kClearlyBelow * median;
    if (!clear) return header != nullptr ? kCannotTell : kNoneFits;
    if (header != nullptr &&
        standard_errors_between(best.residual, header->residual) < kClearErrors)
        return header == &best || header->mean < kClearlyBelow * median ? kAgrees : kCannotTell;
    for (const Candidate& other : finalists) {
        const bool same = other.mean == best.mean;  // shifts that look alike
        if (!same && standard_errors_between(best.residual, other.residual) < kClearErrors)
            return header != nullptr ? kCannotTell : kNoneFits;
    }
    return kShifted;
}

}  // namespace

ExposureSchedule shifted_schedule(const ExposureSchedule& schedule, const ScheduleShift& shift) {
    const int rows = schedule.tile_rows();
    const int cols = schedule.tile_cols();
    const int period = schedule.period_slots();
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            for (Exposure e : schedule.exposures(modulo(row + shift.rows, rows),
                                                 modulo(col + shift.cols, cols))) {
                const int first_slot = static_cast<int>(e.first_slot) - shift.slots % period;
                e.first_slot = static_cast<std::uint32_t>(modulo(first_slot, period));
                exposures.push_back(e);
            }
            first.push_back(static_cast<std::uint32_t>(exposures.size()));
        }
    return {rows, cols, period, std::move(first), std::move(exposures)};
}

ScheduleCheck check_schedule(StreamReader& reader) {
    const StreamHeader& header = reader.header();
    if (header.schedule.weighted())
        throw InputError("exposure schedule",
                         "its exposures are weighted; shifts of weights are not searched");
    if (header.may_switch)
        throw InputError(reader.name(),
                         "may change its schedule between slots; shifts of it are not searched");
    ScheduleCheck check;
    const std::vector<SamplePacket> packets = read_window(reader);
    if (packets.size() < kMinPackets || header.schedule.longest_span_slots() == 0) return check;
    const ResidualMeter meter(header, packets);
    std::vector<Candidate> candidates = all_shifts(header.schedule);
    check.tried = candidates.size();
    remove_impossible(candidates, meter);
    check.possible = candidates.size();
    check.verdict = ScheduleCheck::Verdict::kNoneFits;
    if (candidates.empty()) return check;
    evaluate(candidates, meter, header.shape, kCoarsePixels);
    const double coarse_median = median_of(candidates);
    keep_finalists(candidates);
    evaluate(candidates, meter, header.shape, kFinePixels);
    const double median =
        check.possible > candidates.size() ? coarse_median : median_of(candidates);
    const Candidate& best = *std::ranges::min_element(candidates, {}, &Candidate::mean);
    const Candidate* stated =
        candidates.front().shift == ScheduleShift{} ? &candidates.front() : nullptr;
    check.verdict = judge(candidates, best, stated, median);
    check.shift = smallest(best.shift, header.schedule);
    check.best_residual = best.residual.mean();
    check.median_residual = median;
    if (stated != nullptr) check.header_residual = stated->residual.mean();
    return check;
}

}  // namespace stipple
