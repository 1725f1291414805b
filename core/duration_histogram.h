#pragma once

#include <cstdint>
#include <vector>

namespace stipple {

/// How long things took in a run of any length, in bounded memory: counts in bins of equal ratio.
class DurationHistogram {
  public:
    DurationHistogram();

    /// What is not above 0 counts as the shortest.
    void add(double duration_us);
    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] double longest_us() const { return longest_us_; }
    /// The duration that a share (0..1) of the others do not exceed, within 0.6 % of itself between
    /// 1 ns and 12 days. Precondition: count() > 0.
    [[nodiscard]] double quantile_us(double share) const;

  private:
    std::vector<std::uint64_t> bins_;
    std::uint64_t count_ = 0;
    double longest_us_ = 0;
};

}  // namespace stipple
