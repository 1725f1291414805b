#include "decoder/mosaic_hues.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 12, .cols = 14, .planes = 3};
constexpr std::array kColour{0.3F, 0.5F, 0.7F};  // mean 0.5

FluxVideo constant(int slots) {
    FluxVideo video(slots, kShape);
    for (int slot = 0; slot < slots; ++slot)
        for (std::size_t i = 0; i < kShape.sites(); ++i)
            video.frame(slot)[i] = kColour[i / kShape.pixels()];
    return video;
}

Measurements mosaic_of(const FluxVideo& video, ColourFilter filter) {
    const Recorded recorded = record_mosaic(
        video, filter, random_schedule(12, 14, kPaperExposureSlots, 1),
        {.full_scale_e = 16000, .read_noise_e = 0, .shot_noise = false, .bit_depth = 16});
    return collect_measurements(recorded.header, recorded.packets, whole(video));
}

bool ends_exposure(std::uint8_t state) {
    return (state & Measurements::kLast) != 0;
}

// Half a DN is 0.04 % of light 0.3.
constexpr float kTolerance = 0.002F;

/// Each sample is the sum of the weights times the mean 0.5.
void expect_samples_of_mean(const Measurements& m) {
    EXPECT_EQ(m.shape, (FrameShape{12, 14, 1}));
    EXPECT_FALSE(m.mosaic);
    for (std::size_t pixel = 0; pixel < m.shape.pixels(); ++pixel) {
        float sum = 0;
        for (std::size_t i = pixel; i < m.voxels(); i += m.shape.pixels()) {
            if ((m.state[i] & Measurements::kFirst) != 0) sum = 0;
            sum += 0.5F * m.weight[i];
            if (ends_exposure(m.state[i])) {
                EXPECT_NEAR(m.sum[i], sum, kTolerance * sum);
            }
        }
    }
}

TEST(MosaicHuesTest, EachSampleIsOfTheMeanAndTheColoursComeBack) {
    const FluxVideo video = constant(40);
    for (const ColourFilter filter : {ColourFilter::kRggb, ColourFilter::kGbrg}) {
        const Measurements mosaic = mosaic_of(video, filter);
        const auto known_mean = [&](const Measurements& m, const StageObserver&) {
            expect_samples_of_mean(m);
            EXPECT_EQ(std::ranges::count_if(m.state, ends_exposure),
                      std::ranges::count_if(mosaic.state, ends_exposure));
            FluxVideo mean(m.slots, m.shape);
            std::ranges::fill(mean.data(), 0.5F);
            return std::optional(mean);
        };
        const FluxVideo x = decode_by_hue(mosaic, {}, known_mean).value();
        ASSERT_EQ(x.shape(), kShape);
        for (std::size_t i = 8 * kShape.sites(); i < 32 * kShape.sites(); ++i)
            ASSERT_NEAR(x.data()[i], video.data()[i], kTolerance * video.data()[i]) << i;
    }
}

TEST(MosaicHuesTest, AStoppedDecoderHasNoResult) {
    EXPECT_FALSE(decode_by_hue(
        mosaic_of(constant(8), ColourFilter::kBggr), {},
        [](const Measurements&, const StageObserver&) { return std::optional<FluxVideo>(); }));
}

}  // namespace
}  // namespace stipple
