#include "study/scenes/vector.h"

namespace stipple {

Vec2 direction(double turns) {
    const double quarter = std::floor(turns * 4 + 0.5);
    const double angle = (turns - quarter / 4) * 6.283185307179586;  // |angle| <= pi/4
    const double a2 = angle * angle;
    // Taylor series; the first terms left out are below 2e-9 at pi/4.
    const double s =
        angle * (1 + a2 * (-1.0 / 6 + a2 * (1.0 / 120 + a2 * (-1.0 / 5040 + a2 / 362880))));
    const double c =
        1 + a2 * (-0.5 + a2 * (1.0 / 24 + a2 * (-1.0 / 720 + a2 * (1.0 / 40320 - a2 / 3628800))));
    const double cosine[4] = {c, -s, -c, s};
    const int which = static_cast<int>(wrapped(quarter, 4));
    return {static_cast<float>(cosine[which]), static_cast<float>(cosine[(which + 3) % 4])};
}

float turns_of(Vec2 a) noexcept {
    const float ax = std::abs(a.x);
    const float ay = std::abs(a.y);
    if (ax + ay == 0) return 0;
    const float z = ax > ay ? ay / ax : ax / ay;
    const float z2 = z * z;
    // atan(z) / (2 pi) on 0..1, a minimax polynomial in z^2.
    const float atan_turns =
        z * 0.15915494F *
        (0.99997726F +
         z2 * (-0.33262347F +
               z2 * (0.19354346F + z2 * (-0.11643287F + z2 * (0.05265332F - z2 * 0.0117212F)))));
    float turns = ax > ay ? atan_turns : 0.25F - atan_turns;
    if (a.x < 0) turns = 0.5F - turns;
    return a.y < 0 ? -turns : turns;
}

}  // namespace stipple
