#include <algorithm>
#include <bit>
#include <cmath>

#include "sensor_model/normal.h"
#include "sensor_model/poisson.h"
#include "sensor_model/poisson_sum.h"
#include "sensor_model/poisson_table.h"
#include "sensor_model/portable_math.h"

namespace stipple {
namespace {

using namespace poisson_table;

/// exp(-x) for 0 <= x <= 700. In place of libm, whose last bit varies.
double exp_of_minus(double x) noexcept {
    const double n_and_a_half = x * poisson_sum::kLog2E + 0.5;
    const auto n = static_cast<std::int32_t>(n_and_a_half);  // the power of two next to exp(x)
    const double r = static_cast<double>(n) * poisson_sum::kLn2Low +
                     (static_cast<double>(n) * poisson_sum::kLn2High - x);
    const auto power = static_cast<std::uint64_t>(1023 - n) << 52U;
    return horner(poisson_sum::kExp, r) * std::bit_cast<double>(power);
}

/// The probability u of a word, exact.
double uniform_of(std::uint32_t word) noexcept {
    const double tail =
        (static_cast<double>(static_cast<std::int32_t>(word >> 1U)) + 0.5) * 0x1p-32;
    return (word & 1U) != 0 ? tail : 1.0 - tail;
}

/// floor(mean) + floor(rest), where sqrt(m) w + w^2 g + c is small against the mean and keeps its
/// digits if the mean's integer part stays out of the sum.
struct Quantile {
    float whole;  ///< integer part of the mean
    float rest;   ///< what is to be added to it

    Quantile(float mean, float w, float g, float c) noexcept : whole(std::floor(mean)) {
        rest = std::sqrt(mean) * w + ((w * w) * g + (c + (mean - whole)));
    }
    [[nodiscard]] std::uint32_t count() const noexcept {
        const int k = static_cast<int>(whole) + static_cast<int>(std::floor(rest));
        return static_cast<std::uint32_t>(std::max(k, 0));
    }
};

std::uint32_t poisson_middle(float mean, std::uint32_t word) noexcept {
    const float w = normal_one(word);
    const float inverse_root = 1.0F / std::sqrt(mean);
    const float inverse = inverse_root * inverse_root;
    const float s = w * inverse_root;
    const float t = std::max(std::min(s, kMaxS), kMinS);
    const float c = (horner(kC2, t) * inverse + horner(kC1, t)) * inverse + horner(kC0, t);
    const Quantile x(mean, w, horner(kG, t), c);
    const float off_middle = std::abs((x.rest - std::floor(x.rest)) - 0.5F);
    const bool doubtful = off_middle > 0.5F - kDoubtfulX || std::abs(w) > kDoubtfulW || s != t;
    return doubtful && mean < kRecheckBelow ? poisson_by_sum(mean, word) : x.count();
}

std::uint32_t poisson_large(float mean, std::uint32_t word) noexcept {
    const float w = normal_one(word);
    const float inverse_root = 1.0F / std::sqrt(mean);
    const float s = w * inverse_root;
    const float c = horner(kShortC1, s) * (inverse_root * inverse_root) + horner(kShortC0, s);
    return Quantile(mean, w, horner(kShortG, s), c).count();
}

}  // namespace

std::uint32_t poisson_by_sum(float mean, std::uint32_t word) noexcept {
    const double u = uniform_of(word);
    const double m = static_cast<double>(mean);
    double term = exp_of_minus(m);
    double sum = term;
    std::uint32_t k = 0;
    while (u > sum && k < poisson_sum::kTerms) {
        term = term * (m * poisson_sum::kReciprocal[k]);
        sum = sum + term;
        ++k;
    }
    return k;
}

std::uint32_t poisson_one(float mean, std::uint32_t word) noexcept {
    if (mean < kSumBelow) return poisson_by_sum(mean, word);
    if (mean < kShortFrom) return poisson_middle(mean, word);
    return poisson_large(std::min(mean, kMaxPoissonMean), word);
}

}  // namespace stipple
