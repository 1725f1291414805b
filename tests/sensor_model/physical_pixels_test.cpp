#include "sensor_model/physical_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "sensor_model/pixel_array.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 42;
constexpr FrameShape kShape{.rows = 512, .cols = 1024, .planes = 2};

SensorParams physical(const PhysicalTerms& terms) {
    return {.mode = SensorMode::kPhysical, .physical = terms};
}

PhysicalTerms every_term() {
    return {.quantum_efficiency = 0.6,
            .dark_current_e_per_s = 300,
            .temperature_c = 31,
            .temperature_drift_c_per_s = 100,
            .storage_dark_current_e_per_s = 4000,
            .storage_wait_us = 5000,
            .dsnu_e = 4,
            .prnu = 0.02,
            .read_noise_spread = 0.3,
            .reset_noise_e = 5,
            .row_noise_e = {2, 6, 3},
            .column_noise_e = 1.5,
            .column_temporal_noise_e = 2.5,
            .black_level_dn = 10,
            .hot_pixel_fraction = 0.01,
            .hot_pixel_dark_current = 5000,
            .dead_pixel_fraction = 0.01,
            .response_loss = 0.1,
            .low_gain_read_noise_e = 40,
            .dual_gain_limit_e = 500,
            .device_id = 9,
            .map_cols = 2,
            .transmittance = {1, 0.25},
            .gain_map = {1, 4}};
}

struct Exposures {
    std::vector<std::uint32_t> pixels;
    std::vector<float> light;
    std::vector<std::uint16_t> open_slots;
};

/// Every `step`th pixel with light from none to far beyond the full well.
Exposures mixed(std::size_t count, std::uint32_t step) {
    Exposures exposures;
    for (std::uint32_t i = 0; i < count; ++i) {
        exposures.pixels.push_back(i * step);
        exposures.light.push_back(i % 19 == 0
                                      ? 0.0F
                                      : std::ldexp(1.0F + 0.125F * static_cast<float>(i % 8),
                                                   static_cast<int>(i % 17) - 11));
        exposures.open_slots.push_back(static_cast<std::uint16_t>(1 + i % 8));
    }
    return exposures;
}

std::vector<float> expose(const PhysicalPixels& pixels, const Exposures& exposures,
                          std::uint32_t slot = 5, std::uint32_t plane = 1) {
    std::vector<float> electrons(exposures.pixels.size());
    pixels.expose({exposures.pixels, exposures.light, exposures.open_slots}, slot, plane,
                  {electrons});
    return electrons;
}

TEST(PhysicalPixelsTest, IsTheFormulaWordByWordOnEverySimdTarget) {
    const PhysicalPixels pixels(physical(every_term()), kShape, kSeed);
    for_each_simd_target([&](const std::string& target) {
        for (const std::size_t count : {0U, 1U, 17U, 256U, 257U, 5001U}) {
            const Exposures exposures = mixed(count, 97);
            std::vector<std::uint8_t> clipped(count);
            std::vector<float> electrons(count);
            pixels.expose({exposures.pixels, exposures.light, exposures.open_slots}, 5, 1,
                          {electrons, clipped});
            EXPECT_EQ(electrons, expose(pixels, exposures));
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t pixel = exposures.pixels[i];
                const auto block =
                    philox4x32(random_address(pixel, 5, RandomPurpose::kSample, 1), kSeed);
                const float shared =
                    pixels.row_noise_e(pixel, 5, 1) + pixels.column_noise_e(pixel, 5, 1);
                const float dark_slots =
                    static_cast<float>(exposures.open_slots[i]) * pixels.dark_factor(5);
                const Charge charge = pixels.expose_one(
                    pixels.pattern().plane(1)[pixel], exposures.light[i], dark_slots,
                    {block[0], block[1], shared, pixels.storage_e(pixel, 5, 1)});
                ASSERT_EQ(electrons[i], charge.electrons)
                    << target << " sample " << i << " of " << count;
                ASSERT_EQ(clipped[i] != 0, charge.clipped)
                    << target << " sample " << i << " of " << count;
            }
        }
    });
}

TEST(PhysicalPixelsTest, ClipsChargeAboveTheFullWellAlone) {
    SensorParams params = physical({.quantum_efficiency = 0.5});
    params.full_well_e = 4096;  // at light 8: 512 e a unit
    params.photons_per_unit = 1024;
    params.shot_noise = false;
    params.read_noise_e = 0;
    const float full = 8, above = std::nextafter(full, 9.0F), below = std::nextafter(full, 7.0F);
    const PhysicalPixels pixels(params, {.rows = 1, .cols = 3, .planes = 2}, kSeed);
    const Exposures exposures{{0, 1, 2}, {below, full, above}, {1, 1, 1}};
    std::vector<float> electrons(3);
    std::vector<std::uint8_t> clipped(3);
    pixels.expose({exposures.pixels, exposures.light, exposures.open_slots}, 5, 1,
                  {electrons, clipped});
    EXPECT_EQ(electrons, (std::vector<float>{512 * below, 4096, 4096}));
    EXPECT_EQ(clipped, (std::vector<std::uint8_t>{0, 0, 1}));
}

TEST(PhysicalPixelsTest, WithoutTermsIsEquationOneBitByBit) {
    const Exposures exposures = mixed(3001, 7);
    std::vector<float> expected(exposures.pixels.size());
    PixelArray({}, kSeed).expose(exposures.light, exposures.pixels, 5, 1, {expected});
    EXPECT_EQ(expose(PhysicalPixels(physical({}), kShape, kSeed), exposures), expected);
}

TEST(PhysicalPixelsTest, GivesASampleTheSameChargeInAnyOrder) {
    const PhysicalPixels pixels(physical(every_term()), kShape, kSeed);
    Exposures exposures = mixed(2000, 131);
    auto electrons = expose(pixels, exposures);
    std::ranges::reverse(exposures.pixels);
    std::ranges::reverse(exposures.light);
    std::ranges::reverse(exposures.open_slots);
    std::ranges::reverse(electrons);
    EXPECT_EQ(expose(pixels, exposures), electrons);
}

struct Moments {
    double mean = 0;
    double variance = 0;
};

/// Of the whole array.
Exposures flat_exposures(float light, std::uint16_t open_slots) {
    Exposures flat;
    flat.pixels.resize(kShape.pixels());
    std::iota(flat.pixels.begin(), flat.pixels.end(), 0U);
    flat.light.assign(kShape.pixels(), light);
    flat.open_slots.assign(kShape.pixels(), open_slots);
    return flat;
}

/// Of a flat field over the first plane.
Moments flat_field(const SensorParams& params, float light, std::uint16_t open_slots) {
    const PhysicalPixels pixels(params, kShape, kSeed);
    const Exposures flat = flat_exposures(light, open_slots);
    const auto n = static_cast<double>(kShape.pixels());
    Moments moments;
    const auto electrons = expose(pixels, flat, 3, 0);
    for (const float e : electrons) moments.mean += static_cast<double>(e) / n;
    for (const float e : electrons)
        moments.variance += std::pow(static_cast<double>(e) - moments.mean, 2) / n;
    return moments;
}

// n = 2^19 samples: mean within 5 s / sqrt(n) = 0.007 s, variance within 5 sqrt(2 / n) = 1 %.
void expect_moments(const Moments& found, double mean, double variance) {
    EXPECT_NEAR(found.mean, mean, 0.007 * std::sqrt(variance));
    EXPECT_NEAR(found.variance, variance, 0.01 * variance);
}

TEST(PhysicalPixelsTest, AddsDarkElectronsWithTheirShotNoiseForEveryOpenSlot) {
    // 20000 e/s, 5 ms a slot: 100 e a slot; read noise 10 e.
    const SensorParams params = physical({.dark_current_e_per_s = 20000});
    expect_moments(flat_field(params, 0, 1), 100, 100 + 100);
    expect_moments(flat_field(params, 0, 8), 800, 800 + 100);
    expect_moments(flat_field(params, 0.5, 2), 700, 700 + 100);
}

TEST(PhysicalPixelsTest, AddsTheVariancesOfResetReadAndOffsets) {
    expect_moments(flat_field(physical({.dsnu_e = 6, .reset_noise_e = 12}), 0, 1), 0,
                   100 + 36 + 144);
}

// The well limits the charge that light and dark current leave; noise and offsets are of its
// readout.
TEST(PhysicalPixelsTest, OffsetsAndNoiseLieAboveAFullWell) {
    SensorParams params =
        physical({.dark_current_e_per_s = 20000, .dsnu_e = 6, .reset_noise_e = 12});
    params.full_well_e = 500;
    expect_moments(flat_field(params, 4, 1), 500, 100 + 36 + 144);
    params.physical.low_gain_read_noise_e = 30;
    params.physical.dual_gain_limit_e = 400;
    expect_moments(flat_field(params, 4, 1), 500, 900 + 36 + 144);
}

TEST(PhysicalPixelsTest, TheResetNoiseOfEachExposureIsItsOwn) {
    // The same pixels in two slots: if they shared the draw, the difference would lack it.
    const SensorParams params = physical({.reset_noise_e = 20});
    const PhysicalPixels pixels(params, kShape, kSeed);
    const Exposures dark = flat_exposures(0, 1);
    const auto first = expose(pixels, dark, 3, 0);
    const auto second = expose(pixels, dark, 4, 0);
    double variance = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
        variance += std::pow(static_cast<double>(first[i]) - static_cast<double>(second[i]), 2) /
                    static_cast<double>(first.size());
    EXPECT_NEAR(variance, 2 * (100 + 400), 0.01 * variance);  // as expect_moments
}

TEST(PhysicalPixelsTest, AStorageNodeLeaksWhileItsRowWaits) {
    // 10000 e/s at 20 degrees, so 20000 at 28: 100 e in 5 ms. Row r of 512 waits r / 512
    // of it, in the mean 511 / 1024; the variance of r / 512 is 1 / 12.
    const PhysicalTerms terms{
        .temperature_c = 28, .storage_dark_current_e_per_s = 10000, .storage_wait_us = 5000};
    const double mean = 100 * 511.0 / 1024;
    expect_moments(flat_field(physical(terms), 0, 3), mean, 100 + mean + 1e4 / 12);
    const PhysicalPixels pixels(physical(terms), kShape, kSeed);
    EXPECT_EQ(pixels.storage_e(1023, 7, 0), 0) << "the first row";
    EXPECT_NEAR(pixels.storage_e(256 * 1024, 7, 0), 50, 1e-4);
    EXPECT_NEAR(pixels.storage_e(511 * 1024 + 5, 7, 0), 100 * 511 / 512.0, 1e-4);
    SensorParams exact = physical(terms);
    exact.shot_noise = false;
    exact.read_noise_e = 0;
    const PhysicalPixels mean_only(exact, kShape, kSeed);
    EXPECT_NEAR(expose(mean_only, {{256 * 1024}, {0.5}, {1}}, 3, 0)[0], 500 + 50, 1e-3);
}

TEST(PhysicalPixelsTest, SpreadsTheResponsivity) {
    expect_moments(flat_field(physical({.quantum_efficiency = 0.5, .prnu = 0.05}), 4, 4), 2000,
                   2000 + 100 * 100 + 100);
}

TEST(PhysicalPixelsTest, SharesRowNoiseWithinARowAndTap) {
    SensorParams params = physical({.row_noise_e = {3, 30}});
    params.read_noise_e = 0;
    params.shot_noise = false;
    const PhysicalPixels pixels(params, kShape, kSeed);
    const Exposures dark = flat_exposures(0, 1);
    const auto electrons = expose(pixels, dark, 3, 0);
    double sum2[2] = {0, 0};
    for (std::size_t row = 0; row < 512; ++row)
        for (const std::size_t tap : {0U, 1U}) {
            const auto first =
                electrons.begin() + static_cast<std::ptrdiff_t>(row * 1024 + tap * 512);
            EXPECT_TRUE(std::all_of(first, first + 512, [&](float e) { return e == *first; }));
            sum2[tap] += std::pow(static_cast<double>(*first), 2) / 512;
        }
    // 512 rows: the deviation scatters by 1 / sqrt(1024) = 3 %; 5 of that.
    EXPECT_NEAR(std::sqrt(sum2[0]), 3, 0.16 * 3);
    EXPECT_NEAR(std::sqrt(sum2[1]), 30, 0.16 * 30);
    EXPECT_NE(expose(pixels, dark, 4, 0), electrons);
}

TEST(PhysicalPixelsTest, SharesColumnNoiseWithinAColumn) {
    SensorParams params = physical({.column_temporal_noise_e = 30});
    params.read_noise_e = 0;
    params.shot_noise = false;
    const PhysicalPixels pixels(params, kShape, kSeed);
    double sum2 = 0;
    for (std::uint32_t col = 0; col < 1024; ++col) {
        const Exposures two{{col, 1024 * 300 + col}, {0, 0}, {1, 1}};
        const auto electrons = expose(pixels, two, 3, 0);
        EXPECT_EQ(electrons[0], electrons[1]);
        EXPECT_NE(expose(pixels, two, 4, 0), electrons);
        sum2 += std::pow(static_cast<double>(electrons[0]), 2) / 1024;
    }
    // 1024 columns: the deviation scatters by 1 / sqrt(2048) = 2.2 %; 5 of that.
    EXPECT_NEAR(std::sqrt(sum2), 30, 0.11 * 30);
}

TEST(PhysicalPixelsTest, LosesChargeInProportionToItsSquare) {
    SensorParams params = physical({.response_loss = 0.2});
    params.read_noise_e = 0;
    params.shot_noise = false;
    const PhysicalPixels pixels(params, kShape, kSeed);
    const Exposures bright{
        {0, 1, 2}, {5, 10, 40}, {1, 1, 1}};  // a quarter, a half, beyond the well
    const auto electrons = expose(pixels, bright);
    EXPECT_NEAR(electrons[0], 5000 * (1 - 0.2 / 4), 0.01);
    EXPECT_NEAR(electrons[1], 10000 * (1 - 0.2 / 2), 0.01);
    EXPECT_NEAR(electrons[2], 20000 * (1 - 0.2), 0.01);
}

TEST(PhysicalPixelsTest, ReadsWithTheNoiseOfLowGainAboveTheLimit) {
    SensorParams params = physical({.low_gain_read_noise_e = 50, .dual_gain_limit_e = 2000});
    params.shot_noise = false;
    expect_moments(flat_field(params, 2, 1), 2000, 100);
    expect_moments(flat_field(params, 2.125F, 1), 2125, 2500);
    params.physical.reset_noise_e = 30;  // is in the charge, whatever the gain
    expect_moments(flat_field(params, 2, 1), 2000, 100 + 900);
    expect_moments(flat_field(params, 2.125F, 1), 2125, 2500 + 900);
}

TEST(PhysicalPixelsTest, TheDarkCurrentDoublesWithTheDriftOfTheTemperature) {
    // 8 degrees in 0.4 s, 80 slots of 5 ms.
    const PhysicalPixels pixels(physical({.temperature_drift_c_per_s = 20}), kShape, kSeed);
    EXPECT_EQ(pixels.dark_factor(0), 1.0F);
    EXPECT_NEAR(pixels.dark_factor(80), 2.0, 1e-6);
    EXPECT_NEAR(pixels.dark_factor(160), 4.0, 1e-6);
    EXPECT_EQ(pixels.dark_factor(UINT32_MAX), 0x1p30F);
    SensorParams params =
        physical({.dark_current_e_per_s = 20000, .temperature_drift_c_per_s = 20});
    params.shot_noise = false;
    params.read_noise_e = 0;
    const PhysicalPixels warm(params, kShape, kSeed);
    EXPECT_NEAR(expose(warm, {{7}, {0}, {3}}, 80, 0)[0], 2 * 3 * 100, 1e-3);
}

TEST(PhysicalPixelsTest, APixelHoldsAFullWellAndADeadOneNothing) {
    SensorParams params = physical({.dead_pixel_fraction = 0.2, .gain_map = {0.5}});
    params.read_noise_e = 0;
    const PhysicalPixels pixels(params, kShape, kSeed);
    Exposures bright = mixed(1000, 3);
    bright.light.assign(1000, std::numeric_limits<float>::infinity());
    int dead = 0;
    for (const float e : expose(pixels, bright)) {
        EXPECT_TRUE(e == 10000 || e == 0) << e;
        if (e == 0) ++dead;
    }
    EXPECT_NEAR(dead, 200, 65);
}

TEST(PhysicalPixelsTest, RefusesTermsOutsideTheirRange) {
    EXPECT_THROW(PhysicalPixels(physical({.prnu = -1}), kShape, 1), InputError);
    EXPECT_THROW(PhysicalPixels(physical({.dual_gain_limit_e = 100}), kShape, 1), InputError);
    EXPECT_THROW(PhysicalPixels(physical({.low_gain_read_noise_e = 9}), kShape, 1), InputError);
    EXPECT_THROW(PhysicalPixels(physical({.storage_wait_us = 9}), kShape, 1), InputError);
    EXPECT_THROW(PhysicalPixels(physical({.transmittance = {1, 1}}), kShape, 1), InputError);
}

}  // namespace
}  // namespace stipple
