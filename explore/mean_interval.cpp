#include "explore/mean_interval.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace stipple {
namespace {

/// The probability of -t .. t. Source: Abramowitz and Stegun, 26.7.3 and 26.7.4.
double probability_within(double t, int degrees) {
    const double angle = std::atan(t / std::sqrt(degrees));
    const double cos2 = std::cos(angle) * std::cos(angle);
    const bool is_odd = degrees % 2 == 1;
    double term = is_odd ? std::cos(angle) : 1, sum = degrees == 1 ? 0 : term;
    for (int i = is_odd ? 3 : 2; i < degrees - 1; i += 2) {
        term *= cos2 * (i - 1) / i;
        sum += term;
    }
    sum *= std::sin(angle);
    return is_odd ? (angle + sum) * 2 / std::numbers::pi : sum;
}

}  // namespace

double student_t_975(int degrees) {
    double low = 0, high = 16;  // 12.7 with one degree of freedom, less with more
    while (true) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) return middle;
        (probability_within(middle, degrees) < 0.95 ? low : high) = middle;
    }
}

double mean_of(std::span<const double> samples) {
    if (std::ranges::all_of(samples, [&](double x) { return x == samples.front(); }))
        return samples.front();
    return std::accumulate(samples.begin(), samples.end(), 0.0) /
           static_cast<double>(samples.size());
}

MeanInterval mean_interval(std::span<const double> samples, double t) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const double mean = mean_of(samples);
    if (samples.size() < 2) return {mean, kNone, kNone};
    double squares = 0;
    for (const double x : samples) squares += x == mean ? 0 : (x - mean) * (x - mean);
    if (!std::isfinite(squares)) return {mean, kNone, kNone};
    const auto count = static_cast<double>(samples.size());
    const double half = squares == 0 ? 0 : t * std::sqrt(squares / (count - 1) / count);
    return {mean, mean - half, mean + half};
}

MeanInterval mean_interval(std::span<const double> samples) {
    const auto degrees = static_cast<int>(samples.size()) - 1;
    return mean_interval(samples, degrees > 0 ? student_t_975(degrees) : 0);
}

}  // namespace stipple
