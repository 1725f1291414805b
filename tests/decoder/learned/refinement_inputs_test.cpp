#include "decoder/learned/refinement_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/coded_sensor.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// Of the sensor `paper`: the variance without light, over 32 times its increase per light.
const float kOffset = paper_noise().variance(0) / paper_noise().per_light() / 32;

/// The inputs of all slots of one plane.
class Inputs {
  public:
    Inputs(const Measurements& m, const FluxVideo& estimate, const FluxVideo& start, int plane = 0,
           const SampleNoise& noise = paper_noise())
        : shape_(estimate.shape()) {
        const RefinementInputs inputs(m, noise, {estimate, start});
        for (int slot = 0; slot < estimate.slots(); ++slot) {
            slots_.emplace_back(kRefinementInputs * shape_.pixels());
            inputs.write(slot, plane, slots_.back());
        }
    }
    [[nodiscard]] float at(int input, int slot, int row, int col) const {
        return slots_[index(slot)]
                     [index(input) * shape_.pixels() + row_major(row, col, shape_.cols)];
    }
    [[nodiscard]] std::vector<float> all(int input, int row, int col) const {
        std::vector<float> values;
        for (std::size_t slot = 0; slot < slots_.size(); ++slot)
            values.push_back(at(input, static_cast<int>(slot), row, col));
        return values;
    }

  private:
    FrameShape shape_;
    std::vector<std::vector<float>> slots_;
};

Measurements nothing(const FluxVideo& video) {
    return hand_made(video.slots(), video.shape(), {});
}

TEST(RefinementInputsTest, HasTheRootOfTheEstimateAndTheChangeSinceItsStart) {
    FluxVideo x = flat_video(2, kSite, 0.25F);
    x.data()[1] = -0.1F;
    FluxVideo start = flat_video(2, kSite, 0.64F);
    const Inputs inputs(nothing(x), x, start);
    const float root = std::sqrt(0.25F + kOffset);
    EXPECT_FLOAT_EQ(inputs.at(0, 0, 0, 0), root);
    EXPECT_FLOAT_EQ(inputs.at(1, 0, 0, 0), std::sqrt(0.64F + kOffset) - root);
    EXPECT_FLOAT_EQ(inputs.at(0, 1, 0, 0), std::sqrt(kOffset));
}

TEST(RefinementInputsTest, SharesTheResidualOfASampleAmongItsSlots) {
    // Three slots of 0.2, of which the sample has 0.9: 0.1 is missing in each. Two slots of 0.2, of
    // which a saturated sample has at least 0.3, and one that has at least 0.5.
    const FluxVideo x = flat_video(8, kSite, 0.2F);
    const Measurements m =
        hand_made(8, kSite,
                  {{.first_slot = 0, .open_slots = 0b111, .light = 0.9F},
                   {.first_slot = 3, .open_slots = 0b11, .light = 0.3F, .saturated = true},
                   {.first_slot = 5, .open_slots = 0b11, .light = 0.5F, .saturated = true}});
    const Inputs inputs(m, x, x);
    const float root = std::sqrt(0.2F + kOffset);
    const float q = 2 * 0.1F / root, r = 2 * 0.05F / root;
    const float three = std::log2(3.0F) / 3, two = 1.0F / 3;
    const auto expect = [&](int input, const std::vector<float>& values) {
        for (int slot = 0; slot < 8; ++slot)
            EXPECT_NEAR(inputs.at(input, slot, 0, 0), values[index(slot)], 1e-6)
                << "input " << input << ", slot " << slot;
    };
    expect(6, {q, q, q, 0, 0, r, r, 0});
    expect(9, {q, q, q, q, 0, 0, r, r});
    expect(10, {q, q, 0, 0, r, r, 0, 0});
    expect(7, {three, three, three, two, two, two, two, -1});
    expect(11, {three, three, three, three, two, two, two, two});
    expect(12, {three, three, two, two, two, two, -1, -1});
    expect(8, {0, 0, 0, 1, 1, 1, 1, 0});
}

TEST(RefinementInputsTest, AWeightedSampleIsSharedInProportionToItsWeights) {
    const FluxVideo x = flat_video(2, kSite, 0.2F);
    Measurements m = hand_made(2, kSite, {{.open_slots = 0b11, .light = 0.2F * 1.5F + 0.1F}});
    m.weight = {1, 0.5F};
    const Inputs inputs(m, x, x);
    const float scale = 2 / std::sqrt(0.2F + kOffset);
    // A^T (A A^T)^-1 0.1, A A^T = 1 + 0.25
    EXPECT_NEAR(inputs.at(6, 0, 0, 0), scale * 0.08F, 1e-6);
    EXPECT_NEAR(inputs.at(6, 1, 0, 0), scale * 0.04F, 1e-6);
}

TEST(RefinementInputsTest, FindsTheNeighboursAlongMotion) {
    // A texture that moves 2 pixels right and 1 down in a slot; it changes by 10 % in slot 3.
    constexpr FrameShape kShape{.rows = 48, .cols = 56, .planes = 2};
    FluxVideo x(6, kShape);
    for (int slot = 0; slot < x.slots(); ++slot)
        for (int plane = 0; plane < 2; ++plane)
            for (int row = 0; row < kShape.rows; ++row)
                for (int col = 0; col < kShape.cols; ++col) {
                    const double r = row - slot, c = col - 2 * slot;
                    x.plane(slot, plane)(row, col) =
                        static_cast<float>((0.3 + 0.1 * std::sin(0.7 * r + 0.3 * c) +
                                            0.1 * std::cos(0.45 * c - 0.2 * r)) *
                                           (slot == 3 ? 1.1 : 1));
                }
    const Inputs inputs(nothing(x), x, x, 1);
    const auto root = [&](int slot, int row, int col) {
        return std::sqrt(x.plane(slot, 1)(row, col) + kOffset);
    };
    int far = 0;
    for (int row = 10; row < 38; ++row)
        for (int col = 12; col < 44; ++col)
            for (const auto& [input, step] : {std::pair{2, -2}, {3, -1}, {4, 1}, {5, 2}}) {
                const int slot = 2;
                const float there = root(slot + step, row + step, col + 2 * step);
                const float error =
                    inputs.at(input, slot, row, col) - (there - root(slot, row, col));
                if (std::abs(error) > 0.02F) ++far;
            }
    // The flow is right to a fraction of a pixel; differences at the same pixel would be 0.1.
    EXPECT_LT(far, 28 * 32 * 4 / 50);
    // Nothing beyond the ends.
    EXPECT_EQ(inputs.at(2, 1, 20, 20), 0);
    EXPECT_EQ(inputs.at(3, 0, 20, 20), 0);
    EXPECT_EQ(inputs.at(5, 4, 20, 20), 0);
}

TEST(RefinementInputsTest, WithoutNoiseTheUnitOfLightStays) {
    Calibration calibration = calibration_of({});
    calibration.noise_free = true;
    calibration.electrons_per_unit = 1e6;
    const FluxVideo x = flat_video(2, kSite, 0.2F);
    const Measurements m = hand_made(2, kSite, {{.open_slots = 0b11, .light = 0.5F}});
    const Inputs inputs(m, x, x, 0, SampleNoise(calibration));
    const float root = std::sqrt(0.2F + 0.5F);
    EXPECT_FLOAT_EQ(inputs.at(0, 0, 0, 0), root);
    EXPECT_NEAR(inputs.at(6, 0, 0, 0), 2 * 0.05F / root, 1e-6);
    EXPECT_EQ(inputs.at(14, 0, 0, 0), -1);
}

TEST(RefinementInputsTest, TellsOfTheNoise) {
    const FluxVideo x = flat_video(1, kSite, 0.2F);
    const Inputs paper(nothing(x), x, x);
    EXPECT_NEAR(paper.at(14, 0, 0, 0), 20 * std::sqrt(paper_noise().variance(0)), 1e-6);
}

TEST(RefinementInputsTest, HasTheNoiseLeftInTheEstimateIfItIsKnown) {
    const FluxVideo x = flat_video(2, kSite, 0.2F);
    EXPECT_EQ(Inputs(nothing(x), x, x).at(13, 1, 0, 0), -1);
    FluxVideo gain = flat_video(2, kSite, 1);
    gain.data()[1] = 576;
    const Measurements m = nothing(x);
    const RefinementInputs inputs(m, paper_noise(), {x, x, &gain});
    std::vector<float> seen(kRefinementInputs);
    inputs.write(0, 0, seen);
    EXPECT_EQ(seen[13], 0);
    inputs.write(1, 0, seen);
    EXPECT_NEAR(seen[13], std::log2(576.0F) / 5, 1e-6);
}

TEST(RefinementInputsTest, DoNotDependOnTheUnitOfLight) {
    // Light 1.0 has 1000 electrons, and 1/8 as much light in 8 times the unit.
    Calibration calibration = calibration_of({});
    const SampleNoise noise(calibration);
    calibration.electrons_per_unit *= 8;
    const SampleNoise other(calibration);
    const auto seen = [](float unit, const SampleNoise& of) {
        const FluxVideo x = flat_video(2, kSite, 0.2F / unit);
        const Measurements m = hand_made(2, kSite, {{.open_slots = 0b11, .light = 0.5F / unit}});
        return Inputs(m, x, flat_video(2, kSite, 0.3F / unit), 0, of);
    };
    const Inputs one = seen(1, noise), eight = seen(8, other);
    for (int input = 0; input < kRefinementInputs; ++input)
        EXPECT_NEAR(one.at(input, 0, 0, 0), eight.at(input, 0, 0, 0), 1e-6) << input;
}

TEST(RefinementInputsTest, RestoresTheLightAlsoBeyondTheLargestRoot) {
    FluxVideo x = flat_video(3, kSite, 0.5F);
    x.data()[1] = 40;
    x.data()[2] = 0;
    const Inputs seen(nothing(x), x, x);
    EXPECT_EQ(seen.at(0, 1, 0, 0), RefinementInputs::kMaxRoot);
    const RefinementInputs inputs(nothing(x), paper_noise(), {x, x});
    for (int slot = 0; slot < 3; ++slot) {
        float light = -1;
        const float root = seen.at(0, slot, 0, 0);
        inputs.restore(slot, 0, {&root, 1}, {&light, 1});
        EXPECT_NEAR(light, x.data()[index(slot)], 1e-5);
        const float below = -1;
        inputs.restore(slot, 0, {&below, 1}, {&light, 1});
        if (slot != 1) {
            EXPECT_NEAR(light, -kOffset, 1e-7);
        }
    }
}

}  // namespace
}  // namespace stipple
