#pragma once

#include <cstdint>
#include <vector>

#include "study/scenes/vector.h"

namespace stipple {

/// Reproducible random numbers of a scene: each depends on (seed, item, field) only.
class SceneRandom {
  public:
    explicit SceneRandom(std::uint64_t seed) : seed_(seed) {}

    /// Uniform in [0, 1).
    [[nodiscard]] float uniform(std::uint32_t item, std::uint32_t field) const;
    [[nodiscard]] float between(float low, float high, std::uint32_t item,
                                std::uint32_t field) const {
        return mix(low, high, uniform(item, field));
    }

  private:
    std::uint64_t seed_;
};

/// Band-limited fractal noise, periodic with period 1 in both coordinates: octaves of random
/// lattices from 4 to texels/4 cells, each interpolated by cubic B-splines. The amplitude decreases
/// by the factor `persistence` per octave (1 = equal variance per octave, as in natural images).
/// Mean 0, standard deviation about 1, limited to +-kLimit.
class NoiseTexture {
  public:
    static constexpr float kLimit = 2.5F;

    /// `texels` is a power of two >= 32. `layer` separates textures of the same seed.
    NoiseTexture(int texels, float persistence, const SceneRandom& random, std::uint32_t layer);

    /// Bilinear. Precondition: |u|, |v| < 2^31 / texels.
    [[nodiscard]] float at(float u, float v) const noexcept;

  private:
    void add_octave(int cells, float amplitude, const std::vector<float>& lattice);

    int texels_;
    std::vector<float> values_;
};

/// Textures of the surfaces of all scenes.
struct SceneTextures {
    /// `rows` of the image: the finest detail is about two pixels wide.
    SceneTextures(int rows, std::uint64_t seed);

    SceneRandom random;
    NoiseTexture coarse;  ///< plaster, stone, bark: detail at every scale
    NoiseTexture smooth;  ///< clouds, stains, outlines
};

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
