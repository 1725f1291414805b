#include "io/frame_resampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "decoder/motion/lazy_opencv.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// All slots of `count` frames of one pixel.
std::vector<double> resampled(const ResamplingOptions& options, int count,
                              const std::function<double(int)>& light) {
    int next = 0;
    Floats frame(1);
    FrameResampler resampler({1, 1, 1}, options, [&]() -> std::span<const float> {
        if (next == count) return {};
        frame[0] = static_cast<float>(light(next++));
        return frame;
    });
    std::vector<double> slots;
    for (auto slot = resampler.next(); !slot.empty(); slot = resampler.next())
        slots.push_back(static_cast<double>(slot[0]));
    EXPECT_EQ(static_cast<std::int64_t>(slots.size()),
              resampled_slots(count, options.frames_per_slot));
    EXPECT_TRUE(resampler.next().empty());
    return slots;
}

constexpr Resampling kAll[] = {Resampling::kHold, Resampling::kBlend, Resampling::kFlow};
constexpr double kRates[] = {0.1, 0.3, 0.5, 1.0, 1.001, 1.5, 2.0, 7.3};

TEST(FrameResamplerTest, OneFramePerSlotIsUnchanged) {
    for (const Resampling method : kAll) {
        const auto slots =
            resampled({method, 1}, 5, [](int i) { return i == 2 ? 0.0 : 0.1 + i * i; });
        for (int i = 0; i < 5; ++i)
            EXPECT_EQ(slots[static_cast<std::size_t>(i)],
                      static_cast<double>(static_cast<float>(i == 2 ? 0.0 : 0.1 + i * i)));
    }
}

TEST(FrameResamplerTest, ConstantLightStaysConstant) {
    for (const Resampling method : kAll)
        for (const double rate : kRates)
            for (const double light : resampled({method, rate}, 20, [](int) { return 0.3; }))
                EXPECT_NEAR(light, 0.3, 1e-6) << rate;
}

TEST(FrameResamplerTest, HoldTakesTheFrameAtTheBeginningOfTheSlot) {
    for (const double rate : kRates) {
        const auto slots = resampled({Resampling::kHold, rate}, 30, [](int i) { return i; });
        for (std::size_t k = 0; k < slots.size(); ++k)
            EXPECT_EQ(slots[k], std::floor(static_cast<double>(k) * rate + 1e-9)) << rate;
    }
}

// Light that is linear in time, 10 + t: frame j is its mean over [j, j + 1), slot k that over
// [k r, (k + 1) r). Only in the first and the last frame the slope at the end is unknown.
TEST(FrameResamplerTest, LightThatIsLinearInTimeStaysSo) {
    for (const Resampling method : {Resampling::kBlend, Resampling::kFlow})
        for (const double rate : kRates) {
            const auto slots = resampled({method, rate}, 30, [](int i) { return 10.5 + i; });
            for (std::size_t k = 0; k < slots.size(); ++k) {
                const double middle = (static_cast<double>(k) + 0.5) * rate;
                if (middle - rate / 2 < 1 || middle + rate / 2 > 29) continue;
                EXPECT_NEAR(slots[k], 10 + middle, 1e-4) << rate << ", slot " << k;
            }
        }
}

TEST(FrameResamplerTest, BlendConservesLightAndIsNeverNegative) {
    const auto light = [](int i) { return i % 3 == 1 ? 4.0 : 0.01 * (i % 5); };
    double total = 0;
    for (int i = 0; i < 30; ++i) total += light(i);
    for (const double rate : {0.1, 0.5, 1.5, 2.0, 3.0, 7.5}) {
        double sum = 0;
        for (const double slot : resampled({Resampling::kBlend, rate}, 30, light)) {
            EXPECT_GE(slot, -1e-6) << rate;
            sum += slot * rate;
        }
        EXPECT_NEAR(sum, total, 1e-4 * total) << rate;
    }
}

/// Light that is linear in time, t: a frame of [a, b) has the mean light (a + b) / 2.
constexpr double kBegins[] = {0, 1, 2.5, 2.75, 3, 6, 6.5, 8, 9};

/// Slots of `frames_per_slot` of frames that begin at kBegins plus `origin`.
std::vector<double> of_unequal_frames(Resampling method, double frames_per_slot,
                                      const std::function<double(std::size_t)>& light,
                                      double origin = 0) {
    std::size_t next = 0;
    Floats frame(1);
    const ResamplingOptions options{.method = method,
                                    .frames_per_slot = frames_per_slot,
                                    .time = [&] { return origin + kBegins[next - 1]; }};
    FrameResampler resampler({1, 1, 1}, options, [&]() -> std::span<const float> {
        if (next == std::size(kBegins)) return {};
        frame[0] = static_cast<float>(light(next++));
        return frame;
    });
    std::vector<double> slots;
    for (auto slot = resampler.next(); !slot.empty(); slot = resampler.next())
        slots.push_back(static_cast<double>(slot[0]));
    EXPECT_EQ(slots.size(), static_cast<std::size_t>(10 / frames_per_slot)) << frames_per_slot;
    return slots;
}

double end_of(std::size_t i) {
    return i + 1 < std::size(kBegins) ? kBegins[i + 1] : 10;
}

TEST(FrameResamplerTest, UnequalFramesAreHeldUntilTheNext) {
    for (const double rate : {0.1, 0.4, 1.0, 2.5}) {
        const auto slots = of_unequal_frames(
            Resampling::kHold, rate, [](std::size_t i) { return i; }, 7.25);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            const double begin = static_cast<double>(k) * rate + 1e-9;
            const auto frame = std::ranges::upper_bound(kBegins, begin) - std::begin(kBegins) - 1;
            EXPECT_EQ(slots[k], frame) << rate << ", slot " << k;
        }
    }
}

TEST(FrameResamplerTest, LinearLightOfUnequalFramesStaysLinear) {
    const auto mean = [](std::size_t i) { return 10 + (kBegins[i] + end_of(i)) / 2; };
    for (const double rate : {0.1, 0.4, 1.0, 2.5}) {
        const auto slots = of_unequal_frames(Resampling::kBlend, rate, mean);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            const double middle = (static_cast<double>(k) + 0.5) * rate;
            if (middle - rate / 2 < 1 || middle + rate / 2 > 9) continue;
            EXPECT_NEAR(slots[k], 10 + middle, 1e-4) << rate << ", slot " << k;
        }
    }
}

TEST(FrameResamplerTest, BlendOfUnequalFramesConservesLight) {
    const auto light = [](std::size_t i) { return i % 3 == 1 ? 4.0 : 0.01; };
    double total = 0;
    for (std::size_t i = 0; i < std::size(kBegins); ++i)
        total += light(i) * (end_of(i) - kBegins[i]);
    for (const double rate : {0.1, 0.5, 1.0, 2.5}) {
        double sum = 0;
        for (const double slot : of_unequal_frames(Resampling::kBlend, rate, light)) {
            EXPECT_GE(slot, -1e-6) << rate;
            sum += slot * rate;
        }
        EXPECT_NEAR(sum, total, 1e-4 * total) << rate;
    }
}

// Moments of the light t + 1/2, between which it is linear.
TEST(FrameResamplerTest, FlowTakesUnequalFramesForMoments) {
    const auto slots =
        of_unequal_frames(Resampling::kFlow, 0.25, [](std::size_t i) { return kBegins[i] + 0.5; });
    for (std::size_t k = 2; k < slots.size() - 2; ++k)
        EXPECT_NEAR(slots[k], std::min((static_cast<double>(k) + 0.5) * 0.25, 9.5), 1e-6) << k;
}

TEST(FrameResamplerTest, BlendOfWholeFramesIsTheirMean) {
    const auto slots = resampled({Resampling::kBlend, 3}, 9, [](int i) { return i * i; });
    for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<double>(3 * k);
        EXPECT_NEAR(slots[k], (i * i + (i + 1) * (i + 1) + (i + 2) * (i + 2)) / 3, 1e-5);
    }
}

/// A texture that moves by `step` columns a frame, in three planes.
constexpr FrameShape kShape{48, 64, 3};

Floats texture(double shift) {
    Floats frame(kShape.sites());
    std::size_t site = 0;
    for (int plane = 0; plane < kShape.planes; ++plane)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col) {
                const double x = (col - shift) * 2 * std::numbers::pi;
                const double y = row * 2 * std::numbers::pi;
                frame[site++] = static_cast<float>(1 + 0.4 * std::sin(x / 13 + y / 17) +
                                                   0.3 * std::sin(x / 7 - y / 9) + 0.1 * plane);
            }
    return frame;
}

/// Root mean square error at twice the frame rate, away from the border and the ends.
double error_of_doubling(Resampling method, double step) {
    constexpr int kFrames = 6;
    constexpr int kBorder = 8;
    int next = 0;
    Floats frame;
    FrameResampler resampler(kShape, {method, 0.5, dis_flow}, [&]() -> std::span<const float> {
        if (next == kFrames) return {};
        frame = texture(step * next++);
        return frame;
    });
    double sum = 0;
    double count = 0;
    for (int k = 0; k < 2 * kFrames; ++k) {
        const auto slot = resampler.next();
        if (k < 2 || k >= 2 * kFrames - 2) continue;
        const Floats wanted = texture(step * ((k + 0.5) / 2 - 0.5));
        for (int row = kBorder; row < kShape.rows - kBorder; ++row)
            for (int col = kBorder; col < kShape.cols - kBorder; ++col) {
                const auto site = static_cast<std::size_t>(row * kShape.cols + col);
                sum += std::pow(static_cast<double>(slot[site] - wanted[site]), 2);
                ++count;
            }
    }
    return std::sqrt(sum / count);
}

TEST(FrameResamplerTest, FlowMovesWhatBlendingBlurs) {
    constexpr double kStep = 3;  // of waves of 7 and 13 columns
    const double flow = error_of_doubling(Resampling::kFlow, kStep);
    EXPECT_LT(flow, 0.03);
    EXPECT_LT(5 * flow, error_of_doubling(Resampling::kBlend, kStep));
    EXPECT_LT(5 * flow, error_of_doubling(Resampling::kHold, kStep));
}

}  // namespace
}  // namespace stipple
