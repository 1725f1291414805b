#include "study/metrics/video_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "study/metrics/perceptual.h"
#include "tests/support/noise.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;
constexpr FrameShape kShape{12, 16, 1};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Values such as 0.6F are off by up to 3e-8; an error of 0.1 is then off by 6e-7 relative, its
// PSNR by 8.7 * 6e-7 dB.
constexpr double kToleranceDb = 1e-5;

/// Quality of flat frames: result[t] against reference[t].
VideoQuality flat_quality(const Floats& result, const Floats& reference,
                          const QualityOptions& options = {}) {
    QualityMeter meter(kShape, options);
    for (std::size_t t = 0; t < result.size(); ++t)
        meter.add(Floats(kShape.sites(), result[t]), Floats(kShape.sites(), reference[t]));
    return meter.quality();
}

/// Light from 0 to 2.
Floats bright_noise(std::size_t count, std::uint32_t state) {
    Floats values = noise(count, state);
    for (float& value : values) value *= 2;
    return values;
}

TEST(VideoQualityTest, AnErrorOfATenthIs20Db) {
    const auto quality = flat_quality({0.6F}, {0.5F});
    EXPECT_NEAR(quality.psnr_db, 20, kToleranceDb);
    EXPECT_NEAR(quality.psnr_frame_mean_db, 20, kToleranceDb);
}

TEST(VideoQualityTest, APeakOfTwoAddsSixDecibels) {
    const auto quality = flat_quality({0.6F}, {0.5F}, {.peak = 2});
    EXPECT_NEAR(quality.psnr_db, 20 + 20 * std::log10(2.0), kToleranceDb);
    EXPECT_NEAR(quality.psnr_frame_mean_db, quality.psnr_db, kToleranceDb);
    EXPECT_EQ(quality.psnr_gamma_db, flat_quality({0.6F}, {0.5F}).psnr_gamma_db);
    const double error = pu21(60) - pu21(50);
    EXPECT_NEAR(quality.pu21_psnr_db, 20 * std::log10(pu21(200) / error), 1e-3);
}

TEST(VideoQualityTest, PoolsErrorsButAveragesFrameValues) {
    // Mean squares 1e-2 and 1e-4.
    const auto quality = flat_quality({0.6F, 0.51F}, {0.5F, 0.5F});
    EXPECT_NEAR(quality.psnr_db, -10 * std::log10((1e-2 + 1e-4) / 2), 10 * kToleranceDb);
    EXPECT_NEAR(quality.psnr_frame_mean_db, (20 + 40) / 2, 10 * kToleranceDb);
}

TEST(VideoQualityTest, LinearPsnrDoesNotClampButGammaDoes) {
    const auto quality = flat_quality({3}, {1});
    EXPECT_NEAR(quality.psnr_db, -20 * std::log10(2.0), kToleranceDb);
    EXPECT_EQ(quality.psnr_gamma_db, kInfinity);
    EXPECT_EQ(flat_quality({-1}, {0}).psnr_gamma_db, kInfinity);
}

TEST(VideoQualityTest, GammaPsnrIsTakenAfterTheCurve) {
    // 0.5^2.2 is shown as 0.5 and 1 as 1.
    const auto quality = flat_quality({std::pow(0.5F, 2.2F)}, {1});
    EXPECT_NEAR(quality.psnr_gamma_db, 20 * std::log10(2.0), kToleranceDb);
}

TEST(VideoQualityTest, Pu21PsnrTakesThePeakLuminanceAsItsPeak) {
    for (const double peak : {100.0, 4000.0}) {
        const auto quality = flat_quality({0.5F}, {1}, {.unit_cd_per_m2 = peak});
        const double expected = 20 * std::log10(pu21(peak) / (pu21(peak) - pu21(peak / 2)));
        EXPECT_NEAR(quality.pu21_psnr_db, expected, kToleranceDb);
    }
}

TEST(VideoQualityTest, ClampsBothSidesToTheLargestValue) {
    EXPECT_NEAR(flat_quality({5}, {1.5F}, {.max_value = 2.0}).psnr_db, 20 * std::log10(2.0),
                kToleranceDb);
    EXPECT_EQ(flat_quality({5}, {7}, {.max_value = 2.0}).psnr_db, kInfinity);
    const auto seen = flat_quality({5}, {7}, {.max_value = 2.0, .pu21_ssim = true});
    EXPECT_NEAR(seen.pu21_ssim.value_or(0), 1, 1e-9);
}

TEST(VideoQualityTest, LeavesOutTheMarginAtBothEnds) {
    const Floats reference(5, 0.5F);
    const auto quality = flat_quality({0, 0, 0.6F, 0, 0}, reference, {.margin = 2});
    EXPECT_NEAR(quality.psnr_db, 20, kToleranceDb);
    EXPECT_NEAR(quality.psnr_frame_mean_db, 20, kToleranceDb);
}

TEST(VideoQualityTest, AMarginThatLeavesNothingIsAnError) {
    EXPECT_THROW(flat_quality({0, 0, 0, 0}, Floats(4), {.margin = 2}), InputError);
    EXPECT_THROW(flat_quality({}, {}), InputError);
}

TEST(VideoQualityTest, TheUsualMarginLeavesAFrame) {
    for (int frames = 1; frames < 9; ++frames) {
        const int left = frames - 2 * usual_margin(frames);
        EXPECT_TRUE(left == 1 || left == 2) << frames;
    }
    for (const int frames : {9, 10, 1000}) EXPECT_EQ(usual_margin(frames), 4);
}

TEST(VideoQualityTest, IdenticalVideosAreInfinitelyGood) {
    const Floats frame = bright_noise(kShape.sites(), 1);
    QualityMeter meter(kShape, {});
    meter.add(frame, frame);
    const auto quality = meter.quality();
    EXPECT_EQ(quality.psnr_db, kInfinity);
    EXPECT_EQ(quality.psnr_gamma_db, kInfinity);
    EXPECT_EQ(quality.psnr_frame_mean_db, kInfinity);
    EXPECT_EQ(quality.pu21_psnr_db, kInfinity);
    EXPECT_NEAR(quality.ssim, 1, 1e-12);
}

TEST(VideoQualityTest, SsimIsTheMeanOverFramesAndPlanesAfterTheCurve) {
    const FrameShape shape{12, 16, 3};
    QualityMeter meter(shape, {});
    double expected = 0;
    for (std::uint32_t t = 0; t < 2; ++t) {
        const Floats result = bright_noise(shape.sites(), 10 + t);
        const Floats reference = bright_noise(shape.sites(), 20 + t);
        meter.add(result, reference);
        for (std::size_t plane = 0; plane < 3; ++plane) {
            Floats x;
            Floats y;
            for (std::size_t i = plane * shape.pixels(); i < (plane + 1) * shape.pixels(); ++i) {
                x.push_back(std::pow(std::min(result[i], 1.0F), 1 / 2.2F));
                y.push_back(std::pow(std::min(reference[i], 1.0F), 1 / 2.2F));
            }
            expected += ssim({x.data(), 12, 16}, {y.data(), 12, 16}) / 6;
        }
    }
    EXPECT_NEAR(meter.quality().ssim, expected, 1e-9);
}

TEST(VideoQualityTest, FrameQualitiesAreThoseOfTheFramesAlone) {
    QualityMeter meter(kShape, {.margin = 1, .pu21_ssim = true, .pixels_per_degree = 60.0});
    const Floats half(kShape.sites(), 0.5F);
    for (const float light : {0.0F, 0.6F, 0.51F, 0.0F})
        meter.add(Floats(kShape.sites(), light), half);
    const auto frames = meter.frame_qualities();
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_NEAR(frames[0].psnr_db, 20, kToleranceDb);
    EXPECT_NEAR(frames[1].psnr_db, 40, 10 * kToleranceDb);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto alone = flat_quality({i == 0 ? 0.6F : 0.51F}, {0.5F},
                                        {.pu21_ssim = true, .pixels_per_degree = 60.0});
        EXPECT_EQ(frames[i].psnr_gamma_db, alone.psnr_gamma_db);
        EXPECT_EQ(frames[i].pu21_psnr_db, alone.pu21_psnr_db);
        EXPECT_EQ(frames[i].ssim, alone.ssim);
        EXPECT_EQ(frames[i].pu21_ssim, alone.pu21_ssim);
        EXPECT_EQ(frames[i].pu21_csf_psnr_db, alone.pu21_csf_psnr_db);
    }
    EXPECT_EQ(meter.quality().psnr_frame_mean_db, (frames[0].psnr_db + frames[1].psnr_db) / 2);
    const auto last = flat_quality({0.0F}, {0.5F}, {.pu21_ssim = true});  // in the margin
    EXPECT_EQ(meter.last_quality().psnr_db, last.psnr_db);
    EXPECT_EQ(meter.last_quality().pu21_psnr_db, last.pu21_psnr_db);
    EXPECT_EQ(meter.last_quality().pu21_ssim, last.pu21_ssim);
}

TEST(VideoQualityTest, Pu21SsimOfFlatFramesComparesTheirLuminances) {
    // Without variance only the means count; C1 is 0.01^2 for a range of 1, here 256.
    const double a = pu21(60) / 256;
    const double b = pu21(50) / 256;
    const auto grey = flat_quality({0.6F}, {0.5F}, {.pu21_ssim = true});
    ASSERT_TRUE(grey.pu21_ssim.has_value());
    EXPECT_NEAR(*grey.pu21_ssim, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-6);
    EXPECT_FALSE(flat_quality({0.6F}, {0.5F}).pu21_ssim.has_value());
    QualityMeter colour({12, 16, 3}, {.pu21_ssim = true});
    Floats light(3 * kShape.sites(), 0.6F);
    colour.add(light, Floats(light.size(), 0.5F));
    EXPECT_NEAR(*colour.quality().pu21_ssim, *grey.pu21_ssim, 1e-6);
}

TEST(VideoQualityTest, AConstantErrorCountsInFullToTheEye) {
    const auto quality = flat_quality({0.6F, 0.3F}, {0.5F, 0.4F}, {.pixels_per_degree = 60.0});
    ASSERT_TRUE(quality.pu21_csf_psnr_db.has_value());
    // PU21 values of up to 256 are rounded to 24 bits, and errors of some 10 thereby to 1e-6.
    EXPECT_NEAR(*quality.pu21_csf_psnr_db, quality.pu21_psnr_db, 1e-4);
    EXPECT_FALSE(flat_quality({0.6F}, {0.5F}).pu21_csf_psnr_db.has_value());
}

TEST(VideoQualityTest, IsTheSameForAnyThreadCount) {
    const auto measure = [](int threads) {
        const ThreadLimit limit(threads);
        QualityMeter meter({40, 50, 3}, {.pu21_ssim = true, .pixels_per_degree = 60.0});
        meter.add(bright_noise(40 * 50 * 3, 1), bright_noise(40 * 50 * 3, 2));
        return meter.quality();
    };
    const auto one = measure(1);
    const auto two = measure(2);
    EXPECT_EQ(one.psnr_db, two.psnr_db);
    EXPECT_EQ(one.psnr_gamma_db, two.psnr_gamma_db);
    EXPECT_EQ(one.pu21_psnr_db, two.pu21_psnr_db);
    EXPECT_EQ(one.ssim, two.ssim);
    EXPECT_EQ(one.pu21_ssim, two.pu21_ssim);
    EXPECT_EQ(one.pu21_csf_psnr_db, two.pu21_csf_psnr_db);
}

TEST(VideoQualityTest, RefusesOptionsWithoutAMeaning) {
    for (const FrameShape empty :
         {FrameShape{0, 16, 1}, FrameShape{12, 0, 1}, FrameShape{12, 16, 0}})
        EXPECT_THROW(QualityMeter(empty, {}), InputError);
    EXPECT_THROW(QualityMeter(kShape, {.margin = -1}), InputError);
    EXPECT_THROW(QualityMeter(kShape, {.max_value = 0.0}), InputError);
    EXPECT_THROW(QualityMeter(kShape, {.max_value = 1e-50}), InputError);  // 0 as a float
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (const double value : {0.0, kInfinite}) {
        EXPECT_THROW(QualityMeter(kShape, {.peak = value}), InputError);
        EXPECT_THROW(QualityMeter(kShape, {.unit_cd_per_m2 = value}), InputError);
    }
    EXPECT_THROW(QualityMeter(kShape, {.pixels_per_degree = 0.0}), InputError);
}

}  // namespace
}  // namespace stipple
