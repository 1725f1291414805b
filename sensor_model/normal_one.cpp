#include <bit>
#include <cmath>

#include "sensor_model/normal.h"
#include "sensor_model/normal_table.h"
#include "sensor_model/portable_math.h"

namespace stipple {
namespace {

using namespace normal_table;

/// Natural logarithm of a normal number x > 0. In place of libm, whose last bit varies.
float log_of(float x) noexcept {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23U) - 126);
    const auto mantissa = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F000000U);
    const bool low = mantissa < kSqrtHalf;
    exponent = exponent - (low ? 1.0F : 0.0F);
    const float z = (mantissa + (low ? mantissa : 0.0F)) - 1.0F;
    const float z2 = z * z;
    float y = (horner(kLog, z) * z) * z2;
    y = exponent * kLn2Low + y;
    y = z2 * -0.5F + y;
    return exponent * kLn2High + (z + y);
}

}  // namespace

float normal_one(std::uint32_t word) noexcept {
    const auto half_word = static_cast<std::int32_t>(word >> 1U);
    const float tail = (static_cast<float>(half_word) + 0.5F) * 0x1p-32F;
    const float x = (static_cast<float>(0x7FFFFFFF - half_word) + 0.5F) * 0x1p-31F;
    const float l = 0.0F - log_of(4.0F * (tail * (1.0F - tail)));
    const float p = l < kTailFrom ? horner(kCentre, l - 2.5F) : horner(kTail, std::sqrt(l) - 3.0F);
    return (word & 1U) != 0 ? -(p * x) : p * x;
}

}  // namespace stipple
