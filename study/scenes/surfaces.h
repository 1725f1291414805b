#pragma once

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

/// Relative albedo of a brick wall: light joints, each brick with its own shade.
[[nodiscard]] float brick(Vec2 p, float width, float height) noexcept;

/// Albedo of a wooden board whose grain runs along y, in image heights.
[[nodiscard]] Rgb wood(const SceneTextures& textures, Vec2 p) noexcept;

/// A floor of such boards, `width` wide, with dark joints.
[[nodiscard]] Rgb planks(const SceneTextures& textures, Vec2 p, float width) noexcept;

/// Light of unit strength at the squared distance `d2`; it decreases to 1/4 at `radius`.
constexpr float light_pool(float d2, float radius) {
    return 1 / square(1 + d2 / square(radius));
}

/// x^16 and x^64 without a library call, for highlights.
constexpr float power16(float x) {
    return square(square(square(square(x))));
}
constexpr float power64(float x) {
    return square(square(power16(x)));
}

}  // namespace stipple
