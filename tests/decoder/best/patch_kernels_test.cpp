#include "decoder/best/patch_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr std::size_t kSide = kPatchSide;
constexpr std::size_t kPatches = kGroupPatches;
constexpr std::size_t kCols = 41;
constexpr std::size_t kVoxels = 37 * kCols;

/// A group of 16 patches, some of which overlap, in a frame of 37 x 41.
struct Frames {
    explicit Frames(std::uint32_t seed = 1)
        : noisy(random_values(kVoxels, 0, 2, seed)), pilot(random_values(kVoxels, 0, 2, seed + 1)) {
        for (std::size_t k = 0; k < kPatches; ++k)
            at[k] = static_cast<std::ptrdiff_t>(k / 4 * 7 * kCols + k % 4 * 5);
    }
    [[nodiscard]] GroupFrames group() {
        return {.noisy = noisy.data(),
                .pilot = pilot.data(),
                .sum = sum.data(),
                .weight = weight.data(),
                .cols = kCols,
                .patch = at};
    }
    std::array<std::ptrdiff_t, kPatches> at = {};
    std::vector<float> noisy;
    std::vector<float> pilot;
    std::vector<float> sum = std::vector<float>(kVoxels);
    std::vector<float> weight = std::vector<float>(kVoxels);
};

using Coefficients = std::vector<double>;  // order (patch, row, col)

/// The k-th of `count` orthonormal DCT-II functions at point n.
double cosine(std::size_t k, std::size_t n, std::size_t count) {
    const auto points = static_cast<double>(count);
    return std::sqrt((k == 0 ? 1 : 2) / points) *
           std::cos(std::numbers::pi * (static_cast<double>(n) + 0.5) * static_cast<double>(k) /
                    points);
}

/// The k-th of `count` orthonormal Haar functions at point n: the mean, then halves against each
/// other, quarters, and so on.
double haar(std::size_t k, std::size_t n, std::size_t count) {
    if (k == 0) return 1 / std::sqrt(static_cast<double>(count));
    std::size_t level = 1;
    while (2 * level <= k) level *= 2;
    const std::size_t length = count / level;
    if (n / length != k - level) return 0;
    const double height = std::sqrt(static_cast<double>(level) / static_cast<double>(count));
    return n % length < length / 2 ? height : -height;
}

/// The inner product of a group with each function of the basis, or, `back`, the transpose.
Coefficients transformed(const Coefficients& x, bool back) {
    Coefficients result(x.size());
    constexpr std::size_t kPixels = kSide * kSide;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x.size(); ++j) {
            const std::size_t k = back ? j : i;
            const std::size_t n = back ? i : j;
            result[i] += x[j] * haar(k / kPixels, n / kPixels, kPatches) *
                         cosine(k / kSide % kSide, n / kSide % kSide, kSide) *
                         cosine(k % kSide, n % kSide, kSide);
        }
    return result;
}

Coefficients values(const Frames& frames, const std::vector<float>& from) {
    Coefficients x;
    for (const std::ptrdiff_t at : frames.at)
        for (std::size_t row = 0; row < kSide; ++row)
            for (std::size_t col = 0; col < kSide; ++col)
                x.push_back(
                    static_cast<double>(from[static_cast<std::size_t>(at) + row * kCols + col]));
    return x;
}

TEST(PatchKernelsTest, FilterGroupIsTheWienerFilterInDctTimesHaar) {
    constexpr double kSigma = 0.4;
    Frames frames;
    filter_group(frames.group(), static_cast<float>(kSigma));

    Coefficients noisy = transformed(values(frames, frames.noisy), false);
    const Coefficients pilot = transformed(values(frames, frames.pilot), false);
    double squares = 0;
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        const double factor = pilot[i] * pilot[i] / (pilot[i] * pilot[i] + kSigma * kSigma);
        noisy[i] *= factor;
        squares += factor * factor;
    }
    const Coefficients filtered = transformed(noisy, true);
    constexpr double kWindow[kSide] = {0.45, 0.8, 1, 1, 0.8, 0.45};
    std::vector<double> sum(kVoxels);
    std::vector<double> weight(kVoxels);
    for (std::size_t i = 0; i < filtered.size(); ++i) {
        const std::size_t row = i / kSide % kSide;
        const std::size_t col = i % kSide;
        const auto at = static_cast<std::size_t>(frames.at[i / kSide / kSide]) + row * kCols + col;
        weight[at] += kWindow[row] * kWindow[col] / squares;
        sum[at] += kWindow[row] * kWindow[col] / squares * filtered[i];
    }
    // Values up to 2, some 40 additions in float, weights of 1/squares: 1e-5 of the largest.
    for (std::size_t i = 0; i < kVoxels; ++i) {
        EXPECT_NEAR(static_cast<double>(frames.sum[i]), sum[i], 1e-5 * 8 / squares) << i;
        EXPECT_NEAR(static_cast<double>(frames.weight[i]), weight[i], 1e-5 * 4 / squares) << i;
    }
}

TEST(PatchKernelsTest, WithoutNoiseTheFilterChangesNothing) {
    Frames frames;
    filter_group(frames.group(), 0);
    for (std::size_t i = 0; i < kVoxels; ++i)
        if (frames.weight[i] > 0) {
            EXPECT_NEAR(frames.sum[i] / frames.weight[i], frames.noisy[i], 1e-5F) << i;
        }
}

/// Three planes of a group.
struct ColourFrames {
    Frames planes[3] = {Frames(1), Frames(3), Frames(5)};
    [[nodiscard]] ColourGroupFrames group() {
        return {planes[0].group(), planes[1].group(), planes[2].group()};
    }
    [[nodiscard]] float filtered(std::size_t plane, std::size_t i) const {
        return planes[plane].sum[i] / planes[plane].weight[i];
    }
};

// Planes that are multiples of one plus a constant have one axis on which they vary at all, and on
// it are that plane, longer by the norm of the multiples.
TEST(PatchKernelsTest, ColoursThatVaryTogetherAreFilteredAsOnePlane) {
    constexpr float kShare[3] = {0.6F, 0.48F, 0.64F};  // of norm 1
    Frames mono(7);
    ColourFrames colours;
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t i = 0; i < kVoxels; ++i) {
            colours.planes[p].noisy[i] = kShare[p] * mono.noisy[i];
            colours.planes[p].pilot[i] = kShare[p] * mono.pilot[i];
        }
    filter_group(mono.group(), 0.4F);
    filter_group(colours.group(), 0.4F);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t i = 0; i < kVoxels; ++i)
            if (mono.weight[i] > 0) {
                EXPECT_NEAR(colours.filtered(p, i), kShare[p] * mono.sum[i] / mono.weight[i], 2e-5F)
                    << p << ' ' << i;
            }
}

TEST(PatchKernelsTest, NoiseOfAColourThatThePilotLacksIsTakenOut) {
    ColourFrames colours;
    for (std::size_t i = 0; i < kVoxels; ++i) {
        const float light = colours.planes[0].pilot[i];
        const float noise = colours.planes[0].noisy[i] - 1;
        for (Frames& plane : colours.planes) plane.pilot[i] = light;
        colours.planes[0].noisy[i] = light + noise;
        colours.planes[1].noisy[i] = light;
        colours.planes[2].noisy[i] = light - noise;
    }
    filter_group(colours.group(), 0.01F);
    // Its mean over the group stays, as the pilot has a mean: of 576 values of deviation 0.6.
    for (std::size_t i = 0; i < kVoxels; ++i)
        if (colours.planes[0].weight[i] > 0) {
            EXPECT_NEAR(colours.filtered(0, i) - colours.filtered(2, i), 0, 0.2F) << i;
        }
}

TEST(PatchKernelsTest, WithoutNoiseColoursStayAsTheyAre) {
    ColourFrames colours;
    filter_group(colours.group(), 0);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t i = 0; i < kVoxels; ++i)
            if (colours.planes[p].weight[i] > 0) {
                EXPECT_NEAR(colours.filtered(p, i), colours.planes[p].noisy[i], 2e-5F) << i;
            }
}

TEST(PatchKernelsTest, SquaredDifferencesAreThoseOfSixBySixPixels) {
    const std::vector<float> image = random_values(kVoxels, 0, 2, 3);
    const std::vector<std::uint32_t> at = {0, 3, 5 * kCols + 7, 31 * kCols - 9};
    std::vector<float> result(at.size());
    constexpr std::size_t kReference = 4 * kCols + 11;
    squared_differences(image.data(), &image[kReference], at, kCols, result.data());
    for (std::size_t k = 0; k < at.size(); ++k) {
        double sum = 0;
        for (std::size_t row = 0; row < kSide; ++row)
            for (std::size_t col = 0; col < kSide; ++col) {
                const std::size_t i = row * kCols + col;
                const auto d = static_cast<double>(image[kReference + i] - image[at[k] + i]);
                sum += d * d;
            }
        EXPECT_NEAR(static_cast<double>(result[k]), sum, 1e-5 * sum);
    }
}

TEST(PatchKernelsTest, EverySimdTargetGivesTheSameBits) {
    std::vector<std::vector<float>> found;
    for_each_simd_target([&](const std::string&) {
        Frames frames;
        filter_group(frames.group(), 0.3F);
        std::vector<float> all = frames.sum;
        all.insert(all.end(), frames.weight.begin(), frames.weight.end());
        ColourFrames colours;
        filter_group(colours.group(), 0.3F);
        for (const Frames& plane : colours.planes)
            all.insert(all.end(), plane.sum.begin(), plane.sum.end());
        const std::vector<std::uint32_t> at = {1, 2, 77};
        std::vector<float> differences(at.size());
        squared_differences(frames.noisy.data(), &frames.noisy[200], at, kCols, differences.data());
        all.insert(all.end(), differences.begin(), differences.end());
        found.push_back(all);
    });
    for (const auto& each : found) EXPECT_EQ(each, found.front());
}

}  // namespace
}  // namespace stipple
