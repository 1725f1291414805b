#include "decoder/response_curve.h"

#include <cassert>

namespace stipple {

ResponseCurve::ResponseCurve(const ResponseTable& table)
    : table_(table), slopes_(table.linear_dn.size()) {
    const std::vector<float>& f = table.linear_dn;
    assert(f.size() >= 2 && table.variance_dn2.size() == f.size());
    const std::size_t last = f.size() - 1;
    slopes_[0] = f[1] - f[0];
    slopes_[last] = f[last] - f[last - 1];
    for (std::size_t dn = 1; dn < last; ++dn) slopes_[dn] = (f[dn + 1] - f[dn - 1]) / 2;
}

double ResponseCurve::linear_mean(double mean_dn) const {
    const std::vector<float>& f = table_.linear_dn;
    const std::size_t below = std::min(static_cast<std::size_t>(mean_dn), f.size() - 2);
    const auto start = static_cast<double>(f[below]);
    return start +
           (mean_dn - static_cast<double>(below)) * (static_cast<double>(f[below + 1]) - start);
}

double ResponseCurve::slope_where(double linear_dn) const {
    const auto found = std::ranges::lower_bound(table_.linear_dn, static_cast<float>(linear_dn));
    const auto dn = static_cast<std::size_t>(found - table_.linear_dn.begin());
    return static_cast<double>(slopes_[std::min(dn, slopes_.size() - 1)]);
}

}  // namespace stipple
