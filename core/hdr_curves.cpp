#include "core/hdr_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stipple {
namespace {

/// BT.2100-2, table 4.
namespace pq {
constexpr float kM1 = 2610.0F / 16384;
constexpr float kM2 = 2523.0F / 4096 * 128;
constexpr float kC1 = 3424.0F / 4096;
constexpr float kC2 = 2413.0F / 4096 * 32;
constexpr float kC3 = 2392.0F / 4096 * 32;
}  // namespace pq

/// BT.2100-2, table 5.
namespace hlg {
constexpr float kA = 0.17883277F;
constexpr float kB = 1 - 4 * kA;
constexpr float kC = 0.55991073F;
constexpr double kDisplayCd = 1000;
constexpr double kGamma = 1.2;
}  // namespace hlg

using Matrix = float[3][3];

/// Negative results are kept.
void multiply(const Matrix& matrix, std::span<float> planes) {
    const std::size_t pixels = planes.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float from[3] = {planes[i], planes[pixels + i], planes[2 * pixels + i]};
        for (std::size_t to = 0; to < 3; ++to)
            planes[to * pixels + i] =
                matrix[to][0] * from[0] + matrix[to][1] * from[1] + matrix[to][2] * from[2];
    }
}

}  // namespace

float pq_signal(float cd) {
    const float y = std::clamp(cd / static_cast<float>(kPqMaxCd), 0.0F, 1.0F);
    const float power = std::pow(y, pq::kM1);
    return std::pow((pq::kC1 + pq::kC2 * power) / (1 + pq::kC3 * power), pq::kM2);
}

float pq_luminance(float signal) {
    const float power = std::pow(std::clamp(signal, 0.0F, 1.0F), 1 / pq::kM2);
    const float y = std::max(power - pq::kC1, 0.0F) / (pq::kC2 - pq::kC3 * power);
    return static_cast<float>(kPqMaxCd) * std::pow(y, 1 / pq::kM1);
}

float hlg_signal(float light) {
    const float e = std::clamp(light, 0.0F, 1.0F);
    return e <= 1.0F / 12 ? std::sqrt(3 * e) : hlg::kA * std::log(12 * e - hlg::kB) + hlg::kC;
}

float hlg_light(float signal) {
    const float e = std::clamp(signal, 0.0F, 1.0F);
    return e <= 0.5F ? e * e / 3 : (std::exp((e - hlg::kC) / hlg::kA) + hlg::kB) / 12;
}

double hlg_light_of_luminance(double cd) {
    return std::pow(cd / hlg::kDisplayCd, 1 / hlg::kGamma);
}

float bt709_light(float signal) {
    if (signal < 0.081F) return signal / 4.5F;
    return std::pow((signal + 0.099F) / 1.099F, 1 / 0.45F);
}

void bt709_to_bt2020(std::span<float> planes) {
    constexpr Matrix kMatrix = {{0.627404F, 0.329283F, 0.043313F},
                                {0.069097F, 0.919540F, 0.011362F},
                                {0.016391F, 0.088013F, 0.895595F}};
    multiply(kMatrix, planes);
}

void bt2020_to_bt709(std::span<float> planes) {
    constexpr Matrix kMatrix = {{1.660491F, -0.587641F, -0.072850F},
                                {-0.124550F, 1.132900F, -0.008349F},
                                {-0.018151F, -0.100579F, 1.118730F}};
    multiply(kMatrix, planes);
    for (float& value : planes) value = std::max(value, 0.0F);
}

}  // namespace stipple
