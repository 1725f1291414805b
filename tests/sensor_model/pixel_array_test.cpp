#include "sensor_model/pixel_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "sensor_model/normal.h"
#include "sensor_model/poisson.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 42;
constexpr std::size_t kMany = std::size_t{1} << 20U;

std::vector<std::uint32_t> first_pixels(std::size_t count) {
    std::vector<std::uint32_t> pixels(count);
    std::iota(pixels.begin(), pixels.end(), 0U);
    return pixels;
}

std::vector<float> expose(const SensorParams& params, const std::vector<float>& light,
                          const std::vector<std::uint32_t>& pixels, std::uint32_t slot = 5) {
    std::vector<float> electrons(light.size());
    PixelArray(params, kSeed).expose(light, pixels, slot, 1, {electrons});
    return electrons;
}

std::vector<float> flat_field(const SensorParams& params, float light, std::size_t count = kMany) {
    return expose(params, std::vector<float>(count, light), first_pixels(count));
}

/// Light from none to far beyond the full well, in all exponents; exact in every arithmetic.
std::vector<float> light_of_all_sizes(const std::vector<std::uint32_t>& pixels) {
    std::vector<float> light(pixels.size());
    std::ranges::transform(pixels, light.begin(), [](std::uint32_t pixel) {
        return pixel % 19 == 0 ? 0.0F
                               : std::ldexp(1.0F + 0.125F * static_cast<float>(pixel % 8),
                                            static_cast<int>(pixel % 17) - 11);
    });
    return light;
}

struct Moments {
    double mean;
    double variance;
};

Moments moments(const std::vector<float>& values) {
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double sum2 = 0;
    for (const float value : values) {
        const double deviation = static_cast<double>(value) - mean;
        sum2 += deviation * deviation;
    }
    return {mean, sum2 / n};
}

TEST(PixelArrayTest, IsEquationOneWordByWordOnEverySimdTarget) {
    const SensorParams params;
    const PixelModel model{1000, 20000, 10, true};
    for_each_simd_target([&](const std::string& target) {
        for (const std::size_t count : {0U, 1U, 3U, 15U, 16U, 17U, 40U, 5001U}) {
            const auto pixels = first_pixels(count);
            const auto light = light_of_all_sizes(pixels);
            std::vector<std::uint8_t> clipped(count);
            std::vector<float> electrons(count);
            PixelArray(params, kSeed).expose(light, pixels, 5, 1, {electrons, clipped});
            EXPECT_EQ(electrons, expose(params, light, pixels));
            for (std::size_t i = 0; i < count; ++i) {
                const auto block =
                    philox4x32(random_address(pixels[i], 5, RandomPurpose::kSample, 1), kSeed);
                const Charge charge = expose_one(model, light[i], block[0], block[1]);
                ASSERT_EQ(electrons[i], charge.electrons)
                    << target << " sample " << i << " of " << count;
                ASSERT_EQ(clipped[i] != 0, charge.clipped)
                    << target << " sample " << i << " of " << count;
            }
        }
    });
}

// P(Z > w) of Z ~ Poisson(m), summed from its definition; 5 standard deviations of a share of n
// samples are allowed.
TEST(PixelArrayTest, ClipsTheShareThatPoissonPutsAboveTheFullWell) {
    constexpr std::size_t n = 100000;
    const auto pixels = first_pixels(n);
    const SensorParams params{.full_well_e = 400};
    for (const double mean : {350.0, 390.0, 400.0, 410.0}) {
        double share = 1;
        for (int z = 0; z <= 400; ++z)
            share -= std::exp(z * std::log(mean) - mean - std::lgamma(z + 1.0));
        const std::vector<float> light(n, static_cast<float>(mean / params.photons_per_unit));
        std::vector<float> electrons(n);
        std::vector<std::uint8_t> clipped(n);
        PixelArray(params, kSeed).expose(light, pixels, 5, 0, {electrons, clipped});
        const auto found = static_cast<double>(std::ranges::count(clipped, 1)) / n;
        EXPECT_NEAR(found, share, 5 * std::sqrt(share * (1 - share) / n)) << mean;
    }
}

TEST(PixelArrayTest, GivesASampleTheSameChargeInAnyListAndOrder) {
    const auto pixels = first_pixels(4099);
    const auto light = light_of_all_sizes(pixels);
    const auto whole = expose({}, light, pixels);
    for (const std::size_t tile : {1U, 7U, 64U, 1000U})
        for (std::size_t end = pixels.size(), begin; end > 0; end = begin) {  // last tile first
            begin = end > tile ? end - tile : 0;
            std::vector<std::uint32_t> part(pixels.begin() + static_cast<std::ptrdiff_t>(begin),
                                            pixels.begin() + static_cast<std::ptrdiff_t>(end));
            std::ranges::reverse(part);
            const auto electrons = expose({}, light_of_all_sizes(part), part);
            for (std::size_t i = 0; i < part.size(); ++i)
                ASSERT_EQ(electrons[i], whole[part[i]]) << "tile " << tile << " pixel " << part[i];
        }
}

TEST(PixelArrayTest, DrawsAnewForEverySeedSlotAndPlane) {
    const auto pixels = first_pixels(64);
    const std::vector<float> light(64, 1.0F);
    const auto draw = [&](std::uint64_t seed, std::uint32_t slot, std::uint32_t plane) {
        std::vector<float> electrons(64);
        PixelArray({}, seed).expose(light, pixels, slot, plane, {electrons});
        return electrons;
    };
    EXPECT_EQ(draw(1, 2, 0), draw(1, 2, 0));
    EXPECT_NE(draw(1, 2, 0), draw(2, 2, 0));
    EXPECT_NE(draw(1, 2, 0), draw(std::uint64_t{1} << 32U | 1U, 2, 0));
    EXPECT_NE(draw(1, 2, 0), draw(1, 3, 0));
    EXPECT_NE(draw(1, 2, 0), draw(1, 2, 1));
}

// Eq. 1 before the converter: mean r x, variance r x + sigma^2. The mean of n samples scatters by
// sqrt(variance / n), their variance by about variance sqrt(2 / n) (a little more for small means,
// where Poisson adds its kurtosis 1 / mean); 5 of these are allowed.
TEST(PixelArrayTest, HasTheMeanAndVarianceOfEquationOne) {
    constexpr auto n = static_cast<double>(kMany);
    const SensorParams params;
    for (const float light : {0.0F, 0.001F, 0.02F, 0.09F, 1.0F, 8.0F}) {
        const double mean = params.photons_per_unit * static_cast<double>(light);
        const double variance = mean + params.read_noise_e * params.read_noise_e;
        const Moments found = moments(flat_field(params, light));
        EXPECT_NEAR(found.mean, mean, 5 * std::sqrt(variance / n)) << "light " << light;
        EXPECT_NEAR(found.variance, variance, 5 * variance * std::sqrt(2 / n)) << "light " << light;
    }
}

// A converter without black level clips the negative half: a rectified normal, with mean
// sigma / sqrt(2 pi) = 0.40 sigma and variance sigma^2 (1 / 2 - 1 / (2 pi)) = (0.58 sigma)^2.
TEST(PixelArrayTest, IsARectifiedNormalInTheDarkOnceTheConverterClipsIt) {
    const SensorParams params;
    auto electrons = flat_field(params, 0);
    for (float& e : electrons) e = std::max(e, 0.0F);
    const Moments found = moments(electrons);
    const double sigma = params.read_noise_e;
    const double scatter = 5 / std::sqrt(static_cast<double>(kMany));
    EXPECT_NEAR(found.mean, sigma / std::sqrt(2 * std::numbers::pi), scatter * 0.58 * sigma);
    EXPECT_NEAR(std::sqrt(found.variance), sigma * std::sqrt(0.5 - 0.5 / std::numbers::pi),
                scatter * sigma);
}

TEST(PixelArrayTest, LosesChargeBeyondTheFullWell) {
    for (const float light : {100.0F, 1e6F, 1e30F, HUGE_VALF})
        for (const float e : flat_field({.read_noise_e = 0}, light, 100)) EXPECT_EQ(e, 20000);
}

TEST(PixelArrayTest, CountsWholeElectronsWithoutReadNoise) {
    for (const float e : flat_field({.read_noise_e = 0}, 0, 100)) EXPECT_EQ(e, 0);
    for (const float light : {0.005F, 0.5F, 8.0F})
        for (const float e : flat_field({.read_noise_e = 0}, light, 1000))
            EXPECT_EQ(e, std::floor(e));
}

TEST(PixelArrayTest, GivesTheMeanChargeWithoutNoise) {
    const SensorParams quiet{.read_noise_e = 0, .shot_noise = false};
    for (const float e : flat_field(quiet, 0.75F, 100)) EXPECT_EQ(e, 750);
    for (const float e : flat_field(quiet, 21.0F, 100)) EXPECT_EQ(e, 20000);
}

// Correlation of n independent pairs scatters by 1 / sqrt(n).
TEST(PixelArrayTest, DrawsShotAndReadNoiseIndependently) {
    const auto shot = flat_field({.read_noise_e = 0}, 1.0F);
    const auto both = flat_field({}, 1.0F);
    double product = 0;
    for (std::size_t i = 0; i < kMany; ++i)
        product += (static_cast<double>(shot[i]) - 1000) * static_cast<double>(both[i] - shot[i]);
    const double correlation = product / static_cast<double>(kMany) / (std::sqrt(1000.0) * 10);
    EXPECT_LE(std::abs(correlation), 5 / std::sqrt(static_cast<double>(kMany)));
}

// A recording on purpose: these bits are a promise of the random number layout in
// docs/sensor_model.md, on every machine and compiler. They change only with kRandomLayout.
TEST(PixelArrayTest, KeepsTheRecordedBits) {
    const auto pixels = first_pixels(10000);
    std::uint64_t hash = 14695981039346656037U;  // FNV-1a
    for (const float e : expose({}, light_of_all_sizes(pixels), pixels))
        hash = (hash ^ std::bit_cast<std::uint32_t>(e)) * 1099511628211U;
    EXPECT_EQ(hash, 16530020682322834042U);
}

TEST(PixelArrayTest, RefusesASensorThatIsNotValid) {
    EXPECT_THROW(PixelArray({.full_well_e = 0}, kSeed), InputError);
}

}  // namespace
}  // namespace stipple
