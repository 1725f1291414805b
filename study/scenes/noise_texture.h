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

}  // namespace stipple
