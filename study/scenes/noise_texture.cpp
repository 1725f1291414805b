#include "study/scenes/surfaces.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/philox.h"

namespace stipple {

namespace {

constexpr int kFirstCells = 4;
constexpr int kDefaultTexels = 512;  // two texels a pixel at 240 rows
constexpr int kMaxTexels = 4096;

/// Uniform cubic B-spline weights of the four lattice points around a cell, t in [0, 1).
std::array<float, 4> spline_weights(float t) {
    const float r = 1 - t;
    return {r * r * r / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * r * r * r - 6 * r * r + 4) / 6,
            t * t * t / 6};
}

struct Tap {
    std::array<std::size_t, 4> cell;
    std::array<float, 4> weight;
};

std::vector<Tap> interpolation_taps(int texels, int cells) {
    std::vector<Tap> taps(static_cast<std::size_t>(texels));
    const int texels_per_cell = texels / cells;
    for (int i = 0; i < texels; ++i) {
        Tap& tap = taps[static_cast<std::size_t>(i)];
        const float t =
            static_cast<float>(i % texels_per_cell) / static_cast<float>(texels_per_cell);
        tap.weight = spline_weights(t);
        for (int k = 0; k < 4; ++k)
            tap.cell[static_cast<std::size_t>(k)] =
                static_cast<std::size_t>((i / texels_per_cell + k + cells - 1) % cells);
    }
    return taps;
}

std::vector<float> random_lattice(int cells, const SceneRandom& random, std::uint32_t layer) {
    const auto count = static_cast<std::uint32_t>(cells) * static_cast<std::uint32_t>(cells);
    std::vector<float> lattice(count);
    // (layer, cells) is unique because cells is a power of two of at least 4.
    const std::uint32_t field = layer + static_cast<std::uint32_t>(cells) * 0x100U;
    for (std::uint32_t i = 0; i < count; ++i) lattice[i] = 2 * random.uniform(i, field) - 1;
    return lattice;
}

int texels_for(int rows) {
    int texels = kDefaultTexels;
    while (texels < kMaxTexels && texels < rows * 3 / 2) texels *= 2;
    return texels;
}

}  // namespace

float SceneRandom::uniform(std::uint32_t item, std::uint32_t field) const {
    const auto words = philox4x32(random_address(item, field, RandomPurpose::kScene), seed_);
    return static_cast<float>(words[0] >> 8U) * 0x1p-24F;
}

NoiseTexture::NoiseTexture(int texels, float persistence, const SceneRandom& random,
                           std::uint32_t layer)
    : texels_(texels),
      values_(static_cast<std::size_t>(texels) * static_cast<std::size_t>(texels)) {
    // Variance of one octave: 1/3 (uniform lattice) x 0.479^2 (squared spline weights, averaged).
    // Octaves beyond the default size are left out so that a larger image shows the same scene.
    float variance = 0;
    float amplitude = 1;
    for (int cells = kFirstCells; cells <= kDefaultTexels / 4; cells *= 2) {
        variance += amplitude * amplitude * 0.0765F;
        amplitude *= persistence;
    }
    amplitude = 1 / std::sqrt(variance);
    for (int cells = kFirstCells; cells <= texels / 4; cells *= 2) {
        add_octave(cells, amplitude, random_lattice(cells, random, layer));
        amplitude *= persistence;
    }
    for (float& value : values_) value = std::clamp(value, -kLimit, kLimit);
}

void NoiseTexture::add_octave(int cells, float amplitude, const std::vector<float>& lattice) {
    const std::vector<Tap> taps = interpolation_taps(texels_, cells);
    const auto width = static_cast<std::size_t>(cells);
    parallel_for(0, texels_, [&](int row) {
        const Tap& across = taps[static_cast<std::size_t>(row)];
        std::vector<float> line(width);
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t col = 0; col < width; ++col)
                line[col] += amplitude * across.weight[k] * lattice[across.cell[k] * width + col];
        float* out = &values_[static_cast<std::size_t>(row) * taps.size()];
        for (std::size_t col = 0; col < taps.size(); ++col)
            for (std::size_t k = 0; k < 4; ++k)
                out[col] += taps[col].weight[k] * line[taps[col].cell[k]];
    });
}

float NoiseTexture::at(float u, float v) const noexcept {
    const auto size = static_cast<float>(texels_);
    const int col = floor_int(u * size);
    const int row = floor_int(v * size);
    const float s = u * size - static_cast<float>(col);
    const float t = v * size - static_cast<float>(row);
    const int mask = texels_ - 1;
    const auto width = static_cast<std::size_t>(texels_);
    const float* upper = &values_[static_cast<std::size_t>(row & mask) * width];
    const float* lower = &values_[static_cast<std::size_t>((row + 1) & mask) * width];
    const auto left = static_cast<std::size_t>(col & mask);
    const auto right = static_cast<std::size_t>((col + 1) & mask);
    return mix(mix(upper[left], upper[right], s), mix(lower[left], lower[right], s), t);
}

SceneTextures::SceneTextures(int rows, std::uint64_t seed)
    : random(seed),
      coarse(texels_for(rows), 0.85F, random, 0),
      smooth(texels_for(rows), 0.55F, random, 1) {}

}  // namespace stipple
