#pragma once

#include <cmath>

namespace stipple {

struct Vec2 {
    float x = 0;
    float y = 0;
};

/// A point or direction in space, or a linear colour (x red, y green, z blue).
struct Vec3 {
    float x = 0;
    float y = 0;
    float z = 0;
};
using Rgb = Vec3;

constexpr Vec2 operator+(Vec2 a, Vec2 b) {
    return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator*(float k, Vec2 a) {
    return {k * a.x, k * a.y};
}
constexpr float dot(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(Vec3 a, Vec3 b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 operator*(float k, Vec3 a) {
    return {k * a.x, k * a.y, k * a.z};
}
constexpr float dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 normalized(Vec3 a) {
    return (1 / std::sqrt(dot(a, a))) * a;
}

constexpr float square(float x) {
    return x * x;
}
constexpr float clamp01(float x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}
constexpr float mix(float a, float b, float t) {
    return a + t * (b - a);
}
constexpr Vec3 mix(Vec3 a, Vec3 b, float t) {
    return a + t * (b - a);
}
/// 0 at `from` and before, 1 at `to` and after, smooth between.
constexpr float smooth_step(float from, float to, float x) {
    const float t = clamp01((x - from) / (to - from));
    return t * t * (3 - 2 * t);
}

/// Largest integer <= x. Precondition: |x| < 2^31. (std::floor is a call without SSE4.1.)
constexpr int floor_int(float x) {
    const int whole = static_cast<int>(x);
    return whole - (x < static_cast<float>(whole) ? 1 : 0);
}
constexpr float fraction(float x) {
    return x - static_cast<float>(floor_int(x));
}
/// x modulo period, in [0, period). For times and camera paths, which have no upper limit.
inline double wrapped(double x, double period) {
    return x - period * std::floor(x / period);
}

/// (cos, sin) of an angle in full turns; polynomials, which give the same bits with every C
/// library. Error below 1e-7.
[[nodiscard]] Vec2 direction(double turns);

/// Angle of `a` in turns, -0.5..0.5, y towards positive; polynomial, error below 1e-5 turns.
[[nodiscard]] float turns_of(Vec2 a) noexcept;

/// sin of an angle in full turns.
[[nodiscard]] inline float wave(double turns) {
    return direction(turns).y;
}

/// An orthogonal matrix by its rows.
struct Rotation {
    Vec3 x{1, 0, 0};
    Vec3 y{0, 1, 0};
    Vec3 z{0, 0, 1};

    [[nodiscard]] constexpr Vec3 apply(Vec3 a) const { return {dot(x, a), dot(y, a), dot(z, a)}; }
    [[nodiscard]] constexpr Vec3 apply_inverse(Vec3 a) const { return a.x * x + a.y * y + a.z * z; }
};

}  // namespace stipple
