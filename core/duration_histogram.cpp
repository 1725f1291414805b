#include "core/duration_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stipple {
namespace {

constexpr double kBinsPerOctave = 64;
constexpr double kShortestUs = 0x1p-10;
constexpr std::size_t kBins = 50 * 64;

std::size_t bin_of(double duration_us) {
    const double octaves = std::log2(std::max(duration_us, kShortestUs) / kShortestUs);
    return std::min(static_cast<std::size_t>(octaves * kBinsPerOctave), kBins - 1);
}

double middle_us(std::size_t bin) {
    return kShortestUs * std::exp2((static_cast<double>(bin) + 0.5) / kBinsPerOctave);
}

}  // namespace

DurationHistogram::DurationHistogram() : bins_(kBins) {}

void DurationHistogram::add(double duration_us) {
    ++bins_[bin_of(duration_us)];
    ++count_;
    longest_us_ = std::max(longest_us_, duration_us);
}

double DurationHistogram::quantile_us(double share) const {
    const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(count_ - 1) + 0.5);
    if (rank + 1 >= count_) return longest_us_;
    std::uint64_t below = 0;
    std::size_t bin = 0;
    while ((below += bins_[bin]) <= rank) ++bin;
    return std::min(middle_us(bin), longest_us_);
}

}  // namespace stipple
