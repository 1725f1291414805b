#include "decoder/opponent_planes.h"

namespace stipple {
namespace {

constexpr float kRoot2 = 0.70710678F;  // 1 / sqrt(2)
constexpr float kRoot3 = 0.57735027F;
constexpr float kRoot6 = 0.40824829F;

}  // namespace

void to_opponents(std::size_t count, const PlaneTriple& planes) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        const float red = planes.first[i];
        const float green = planes.second[i];
        const float blue = planes.third[i];
        planes.first[i] = (red + green + blue) * kRoot3;
        planes.second[i] = (red - blue) * kRoot2;
        planes.third[i] = (red - 2 * green + blue) * kRoot6;
    }
}

void from_opponents(std::size_t count, const PlaneTriple& planes) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        const float luma = planes.first[i] * kRoot3;
        const float red_blue = planes.second[i] * kRoot2;
        const float green = planes.third[i] * kRoot6;
        planes.first[i] = luma + red_blue + green;
        planes.second[i] = luma - 2 * green;
        planes.third[i] = luma - red_blue + green;
    }
}

}  // namespace stipple
