#include "capture/clock_fit.h"

#include <gtest/gtest.h>

#include "core/philox.h"

namespace stipple {
namespace {

TEST(ClockFitTest, FindsOffsetAndDriftBelowTheJitterOfArrivals) {
    // 200 frames/s for 60 s; the host's clock gains 40 ppm; a way of 200 us, on a quarter of the
    // frames up to 8 ms longer. The least of the 200 delays of a second is the way itself, but for
    // the drift within the second, 40 us/s * 1 s at most.
    ClockFitter fitter(2);
    constexpr std::int64_t kOffset = 123'456'789'000;
    for (std::int64_t i = 0; i < 12000; ++i) {
        const std::int64_t device = 5'000'000'000 + i * 5'000'000;
        const std::uint32_t draw = philox4x32({static_cast<std::uint32_t>(i), 0, 0, 0}, 1)[0];
        const std::int64_t jitter = draw % 4 == 0 ? draw % 8'000'000 : 0;
        fitter.add(device, device + kOffset + i * 200 + 200'000 + jitter);
    }
    const auto fit = fitter.fit();
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->epoch, 2U);
    EXPECT_EQ(fit->frames, 12000U);
    EXPECT_EQ(fit->origin_ns, 5'000'000'000);
    EXPECT_NEAR(fit->drift_ppm, 40, 1);
    EXPECT_NEAR(static_cast<double>(fit->offset_ns - kOffset), 200'000, 40'000);
    EXPECT_LT(fit->spread_ns, 40'000);
}

TEST(ClockFitTest, OneFrameGivesItsOffset) {
    ClockFitter fitter;
    EXPECT_FALSE(fitter.fit());
    fitter.add(100, 50);
    const auto fit = fitter.fit();
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->offset_ns, -50);
    EXPECT_EQ(fit->drift_ppm, 0);
}

TEST(ClockFitTest, ADayOfStampsTakesBoundedMemoryAndKeepsTheDrift) {
    ClockFitter fitter;
    for (std::int64_t second = 0; second < 200'000; ++second) {
        const std::int64_t device = second * 1'000'000'000;
        fitter.add(device, device + 1000 - second * 3000);
    }
    EXPECT_NEAR(fitter.fit()->drift_ppm, -3, 1e-3);
}

}  // namespace
}  // namespace stipple
