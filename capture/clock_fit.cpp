#include "capture/clock_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

constexpr std::size_t kMaxBins = 65536;

/// Difference of two stamps, which may be anything in a damaged file.
std::int64_t wrapping_difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

}  // namespace

void ClockFitter::add(std::int64_t device_ns, std::int64_t host_ns) {
    if (fit_.frames++ == 0) {
        fit_.origin_ns = device_ns;
        fit_.offset_ns = wrapping_difference(host_ns, device_ns);
    }
    const Bin sample{wrapping_difference(device_ns, fit_.origin_ns),
                     wrapping_difference(wrapping_difference(host_ns, device_ns), fit_.offset_ns)};
    const std::int64_t bin = sample.device_ns / bin_ns_;
    if (bins_.empty() || bin != current_bin_) {
        if (bins_.size() >= kMaxBins) merge_bins();
        bins_.push_back(sample);
        current_bin_ = sample.device_ns / bin_ns_;
    } else if (sample.delay_ns < bins_.back().delay_ns) {
        bins_.back() = sample;
    }
}

void ClockFitter::merge_bins() {
    const auto earlier = [](const Bin& a, const Bin& b) { return a.delay_ns < b.delay_ns; };
    for (std::size_t i = 0; i < bins_.size() / 2; ++i)
        bins_[i] = std::min(bins_[2 * i], bins_[2 * i + 1], earlier);
    bins_.resize(bins_.size() / 2);
    bin_ns_ *= 2;
}

std::optional<ClockFit> ClockFitter::fit() const {
    if (bins_.empty()) return std::nullopt;
    static_assert(sizeof(Bin) == 2 * sizeof(std::int64_t));
    using Column = Eigen::Map<const Eigen::Array<std::int64_t, Eigen::Dynamic, 1>, Eigen::Unaligned,
                              Eigen::InnerStride<2>>;
    const Column device_ns(&bins_.front().device_ns, std::ssize(bins_));
    const Column delay_ns(&bins_.front().delay_ns, std::ssize(bins_));
    const auto time = device_ns.cast<double>();
    const auto delay = delay_ns.cast<double>();
    const double mean_time = time.mean();
    const double mean_delay = delay.mean();
    const double variance = (time - mean_time).square().sum();
    const double covariance = ((time - mean_time) * (delay - mean_delay)).sum();
    const double slope = variance > 0 ? covariance / variance : 0;
    const double start = mean_delay - slope * mean_time;
    ClockFit result = fit_;
    if (std::abs(start) < 9e18)
        result.offset_ns =
            static_cast<std::int64_t>(static_cast<std::uint64_t>(fit_.offset_ns) +
                                      static_cast<std::uint64_t>(std::llround(start)));
    result.drift_ppm = slope * 1e6;
    result.spread_ns = std::sqrt((delay - start - slope * time).square().mean());
    return result;
}

}  // namespace stipple
