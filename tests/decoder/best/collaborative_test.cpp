#include "decoder/best/collaborative.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/coded_sensor.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr int kSlots = 16;

/// Bright chequers that drift by a pixel a slot over darker, finer ones.
FluxVideo drifting(FrameShape shape) {
    FluxVideo video(kSlots, shape);
    for (int slot = 0; slot < kSlots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const int x = col + 200 - slot;
                    const bool bright = row > 12 && row < 36 && x % 64 < 30;
                    video.plane(slot, plane)(row, col) =
                        bright ? 0.9F - 0.3F * static_cast<float>((x / 6 + row / 6) % 2)
                               : 0.1F + 0.1F * static_cast<float>((col / 4 + row / 4) % 2);
                }
    return video;
}

ExposureSchedule schedule(FrameShape shape) {
    return random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
}

double psnr_db(const FluxVideo& x, const FluxVideo& truth) {
    return -10 * std::log10(mean_square(x.data(), truth.data()));
}

class CollaborativeTest : public testing::TestWithParam<int> {
  protected:
    [[nodiscard]] static FrameShape shape() {
        return {.rows = 48, .cols = 56, .planes = GetParam()};
    }
    static FluxVideo decode(const CollaborativeOptions& options = {}) {
        Measurements m = measure(drifting(shape()), schedule(shape()));
        return *decode_collaborative(m, SampleNoise(calibration_of({})), options);
    }
};

TEST_P(CollaborativeTest, BestIsBetterThanItsStart) {
    const FluxVideo truth = drifting(shape());
    const FluxVideo start = decode({.iterations = 0});
    const bool mono = GetParam() == 1;
    expect_quality("start", psnr_db(start, truth), mono ? 27.95 : 27.55);
    expect_quality("best", psnr_db(decode(), truth), mono ? 32.73 : 32.69);
}

TEST_P(CollaborativeTest, TheSameBitsForOneAndTwoThreads) {
    const auto bits = [](int threads) {
        const ThreadLimit limit(threads);
        const FluxVideo x = decode({.iterations = 2});
        return std::vector<float>(x.data().begin(), x.data().end());
    };
    EXPECT_EQ(bits(1), bits(2));
}

INSTANTIATE_TEST_SUITE_P(Planes, CollaborativeTest, testing::Values(1, 3));

TEST(CollaborativeSmallTest, AFrameTooSmallForPatchesStaysAsItsStart) {
    for (const FrameShape shape :
         {FrameShape{1, 40, 1}, FrameShape{40, 1, 1}, FrameShape{5, 9, 3}}) {
        const Measurements m = measure(drifting(shape), schedule(shape));
        Measurements first = m;
        Measurements second = m;
        const SampleNoise noise(calibration_of({}));
        const auto x = decode_collaborative(first, noise, {});
        const auto start = decode_motion_tv(second, noise, {});
        EXPECT_TRUE(std::ranges::equal(x->data(), start->data()));
    }
}

TEST(CollaborativeSmallTest, SamplesAreAsBeforeAndStoppingLeavesNothing) {
    const FrameShape shape{24, 24, 1};
    Measurements m = measure(drifting(shape), schedule(shape));
    const auto sums = m.sum;
    const SampleNoise noise(calibration_of({}));
    EXPECT_TRUE(decode_collaborative(m, noise, {.iterations = 5}));
    EXPECT_EQ(m.sum, sums);
    EXPECT_FALSE(decode_collaborative(m, noise, {}, [](double done) { return done < 0.5; }));
    EXPECT_EQ(m.sum, sums);
}

}  // namespace
}  // namespace stipple
