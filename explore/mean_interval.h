#pragma once

#include <limits>
#include <span>

namespace stipple {

/// Where the mean of a random figure lies.
struct MeanInterval {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double low = mean;
    double high = mean;

    /// Whether the mean may be 0. An interval that is not known may hold any value.
    [[nodiscard]] bool may_be_zero() const { return !(low > 0) && !(high < 0); }
};

/// The t below which a variable of Student's distribution lies with a probability of 97.5 %.
/// Precondition: degrees > 0.
[[nodiscard]] double student_t_975(int degrees);

/// Equal samples have themselves as mean, to the last bit. Precondition: there are samples.
[[nodiscard]] double mean_of(std::span<const double> samples);

/// The interval that holds the mean of a normal variable with a probability of 95 %, by Student's
/// t: mean +- t s / sqrt(n). NaN as its ends: of less than two samples, or of some that are
/// infinite; equal samples are their own interval. Precondition: there are samples.
/// `t` is student_t_975 of one less than their number.
[[nodiscard]] MeanInterval mean_interval(std::span<const double> samples, double t);
[[nodiscard]] MeanInterval mean_interval(std::span<const double> samples);

}  // namespace stipple
