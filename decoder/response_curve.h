#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stream/stream_header.h"

namespace stipple {

/// A response table f with its slopes f', for the samples of a chip.
class ResponseCurve {
  public:
    /// `table` must outlive this. Precondition: it has two numbers or more, strictly rising.
    explicit ResponseCurve(const ResponseTable& table);

    /// f(DN). A DN beyond the table counts as its last one.
    [[nodiscard]] double linear_dn(std::uint16_t dn) const {
        return static_cast<double>(table_.linear_dn[at(dn)]);
    }
    /// f of a mean of samples, interpolated. Precondition: mean_dn >= 0.
    [[nodiscard]] double linear_mean(double mean_dn) const;
    /// f'(DN): half the difference of the numbers beside it.
    [[nodiscard]] float slope(std::uint16_t dn) const { return slopes_[at(dn)]; }
    /// f' at the DN for which f is `linear_dn`, or at the end of the table.
    [[nodiscard]] double slope_where(double linear_dn) const;
    /// Variance of f(DN), in DN^2.
    [[nodiscard]] float variance_dn2(std::uint16_t dn) const { return table_.variance_dn2[at(dn)]; }

  private:
    [[nodiscard]] std::size_t at(std::uint16_t dn) const {
        return std::min<std::size_t>(dn, slopes_.size() - 1);
    }

    const ResponseTable& table_;
    std::vector<float> slopes_;
};

}  // namespace stipple
