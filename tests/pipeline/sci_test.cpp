// The video-SCI benchmark on stand-ins: masks, an ideal sensor, 8 frames a measurement.
#include "tests/bench/sci/sci_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "io/npy_file.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{64, 64, 1};

double psnr_of(const FluxVideo& video, DecodeMethod method) {
    return sci_psnr_db(video, random_masks(video.shape(), 1), {}, {.method = method});
}

TEST(SciTest, TheMasksAreHalfOnesAndDifferFromFrameToFrame) {
    const NpyVolume masks = random_masks(kShape, 1);
    ASSERT_EQ(masks.values.size(), 8 * kShape.pixels());
    double ones = 0;
    double equal = 0;
    for (std::size_t i = 0; i < masks.values.size(); ++i) {
        ones += masks.values[i];
        equal += masks.values[i] == masks.values[(i + kShape.pixels()) % masks.values.size()];
    }
    const double n = static_cast<double>(masks.values.size());
    EXPECT_NEAR(ones / n, 0.5, 4 * 0.5 / std::sqrt(n));
    EXPECT_NEAR(equal / n, 0.5, 4 * 0.5 / std::sqrt(n));
}

// At rest the mean of a measurement is the light, up to the rounding to 16 bits (8 / 65535 / 2).
TEST(SciTest, AStillImageIsExactButForRounding) {
    FluxVideo video(8, kShape);
    for (int slot = 0; slot < 8; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                video.plane(slot, 0)(row, col) = static_cast<float>(row + col) / 130;
    // A pixel whose masks are all 0 (1 in 256) is unknown to `naive`.
    NpyVolume masks = random_masks(kShape, 1);
    std::fill_n(masks.values.begin(), kShape.pixels(), 1.0);
    expect_quality("naive", sci_psnr_db(video, masks, {}, {.method = DecodeMethod::kNaive}),
                   100.37);
    expect_quality("fast", sci_psnr_db(video, masks, {}, {.method = DecodeMethod::kFast}), 58.34);
}

TEST(SciTest, FastIsFarBetterThanNaive) {
    const FluxVideo video = sci_stand_in("roll", 16, {128, 128, 1});
    const double naive = psnr_of(video, DecodeMethod::kNaive);
    const double fast = psnr_of(video, DecodeMethod::kFast);
    expect_quality("naive", naive, 24.41);
    expect_quality("fast", fast, 27.07);
    EXPECT_GT(fast, naive + 2.5);
}

// The weights of a grey mask differ less than those of a binary one, the more so after a blur: the
// measurements tell the slots apart less well, and yet better than the naive estimate does.
TEST(SciTest, GreyAndBlurredMasksDecodeToo) {
    const FluxVideo video = sci_stand_in("roll", 16, {128, 128, 1});
    const auto psnr = [&](const NpyVolume& masks, DecodeMethod method) {
        return sci_psnr_db(video, masks, {}, {.method = method});
    };
    const NpyVolume grey = grey_masks(video.shape(), 1);
    const NpyVolume blurred = blurred_masks(random_masks(video.shape(), 1));
    expect_quality("grey", psnr(grey, DecodeMethod::kFast), 25.68);
    expect_quality("blurred", psnr(blurred, DecodeMethod::kFast), 25.15);
    for (const NpyVolume& masks : {grey, blurred})
        EXPECT_GT(psnr(masks, DecodeMethod::kFast), psnr(masks, DecodeMethod::kNaive));
}

// The same six options as in docs/notes/sci_benchmark.md, and the same bits.
TEST(SciTest, TheFlagOfTheStreamGivesBestTheOptionsForSamplesWithoutNoise) {
    const FluxVideo video = sci_stand_in("roll", 8, {48, 48, 1});
    const NpyVolume masks = random_masks(video.shape(), 1);
    DecodeOptions options{.method = DecodeMethod::kBest};
    options.best.noise_free.iterations = 10;
    const double with_flag = sci_psnr_db(video, masks, {.noise_free = true}, options);
    options.best.iterations = 10;
    options.best.first_sigma = 0.12F;
    options.best.last_noise = 0;
    options.best.min_sigma = 0.008F;
    options.best.light_offset = 0.5F;
    options.best.residual_gain = 1;
    options.best.residual_decay = 1;
    EXPECT_EQ(sci_psnr_db(video, masks, {}, options), with_flag);
}

TEST(SciTest, ReadsWholeMeasurementsOfAClip) {
    const TemporaryFolder folder;
    const FluxVideo video = sci_stand_in("pan", 19, {16, 24, 1});
    NpyWriter writer(folder / "kobe32.npy", "kobe32.npy", video.shape());
    for (int slot = 0; slot < video.slots(); ++slot) writer.write(video.frame(slot));
    writer.finish();
    const FluxVideo clip = read_sci_clip(folder.path(), "kobe32");
    EXPECT_EQ(clip.slots(), 16);
    EXPECT_TRUE(std::ranges::equal(clip.frame(15), video.frame(15)));
    EXPECT_THROW(static_cast<void>(read_sci_clip(folder.path(), "drop40")), InputError);
}

TEST(SciTest, RefusesMasksOfAnotherSize) {
    const FluxVideo video = sci_stand_in("pan", 8, {16, 24, 1});
    const auto psnr = [&](const NpyVolume& masks) {
        return sci_psnr_db(video, masks, {}, {.method = DecodeMethod::kNaive});
    };
    expect_parts(message_of<InputError>([&] { return psnr(random_masks(kShape, 1)); }),
                 {"masks", "8 x 64 x 64", "8 x 16 x 24"});
    NpyVolume grey = random_masks(video.shape(), 1);
    grey.values[5] = -0.5;
    expect_parts(message_of<InputError>([&] { return psnr(grey); }), {"masks", "-0.5"});
}

}  // namespace
}  // namespace stipple
