#include "decoder/learned/learned.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/error.h"
#include "decoder/learned/refinement_inputs.h"
#include "decoder/learned/refinement_network.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "tests/decoder/learned/plain_network.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 24, .cols = 28, .planes = 1};
const CollaborativeOptions kShort{.iterations = 4};
const float kOffset = paper_noise().variance(0) / paper_noise().per_light() / 32;

Measurements samples() {
    return measure(moving_bar(kShape),
                   random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
}

const ProgressCallback kGoOn = [](double) { return true; };

FluxVideo learned(const Refiner& refine) {
    Measurements m = samples();
    return *decode_learned({m, paper_noise(), kGoOn}, kShort, refine);
}

FluxVideo learned_fast(const Refiner& refine) {
    Measurements m = samples();
    return *decode_learned_fast({m, paper_noise(), kGoOn}, {}, refine);
}

void keep(const RefinerInput& input, std::span<float> refined) {
    std::ranges::copy(input.inputs.first(refined.size()), refined.begin());
}

/// Squares of roots are rounded; light below 0 has the root of 0.
void expect_near(const FluxVideo& a, const FluxVideo& b) {
    ASSERT_EQ(a.voxels(), b.voxels());
    for (std::size_t i = 0; i < a.voxels(); ++i) ASSERT_NEAR(a.data()[i], b.data()[i], 1e-6);
}

TEST(LearnedTest, ARefinerThatKeepsTheEstimateLeavesThatOfTheMethod) {
    Measurements for_best = samples(), for_fast = samples();  // whose variances change
    expect_near(learned(keep), *decode_collaborative(for_best, paper_noise(), kShort));
    expect_near(learned_fast(keep), *decode_motion_tv(for_fast, paper_noise(), {}));
}

TEST(LearnedTest, TheStartIsTheEstimateOfFast) {
    Measurements m = samples();
    const FluxVideo fast = *decode_motion_tv(m, paper_noise(), {});
    int slot = 0;
    learned([&](const RefinerInput& input, std::span<float> refined) {
        keep(input, refined);
        for (std::size_t i = 0; i < refined.size(); ++i)
            ASSERT_NEAR(refined[i] + input.inputs[refined.size() + i],
                        std::sqrt(std::max(fast.frame(slot)[i], 0.0F) + kOffset), 1e-6);
        ++slot;
    });
    EXPECT_EQ(slot, 16);
    learned_fast([](const RefinerInput& input, std::span<float> refined) {
        keep(input, refined);
        for (std::size_t i = 0; i < refined.size(); ++i)
            ASSERT_EQ(input.inputs[refined.size() + i], 0);
    });
}

TEST(LearnedTest, ARefinerThatKnowsTheTruthGivesItBack) {
    const FluxVideo truth = moving_bar(kShape);
    for (const auto& decode : {learned, learned_fast}) {
        int slot = 0;
        expect_near(decode([&](const RefinerInput&, std::span<float> refined) {
                        const auto frame = truth.frame(slot++);
                        std::ranges::transform(frame, refined.begin(),
                                               [](float x) { return std::sqrt(x + kOffset); });
                    }),
                    truth);
    }
}

TEST(LearnedTest, WhatTheSamplesContradictStaysTheEstimate) {
    FluxVideo video = moving_bar(kShape);
    for (float& light : video.data()) light *= 0.2F;  // 8 slots of it are below full scale
    Measurements m =
        measure(video, random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
    Measurements for_fast = m;  // whose variances change
    const FluxVideo fast = *decode_motion_tv(for_fast, paper_noise(), {});
    const FluxVideo refined = *decode_learned_fast(
        {m, paper_noise(), kGoOn}, {}, [](const RefinerInput& input, std::span<float> roots) {
            keep(input, roots);
            for (float& root : roots) root += 1;
        });
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        const bool measured = (m.state[i] & Measurements::kOpen) != 0;
        EXPECT_EQ(refined.data()[i] == fast.data()[i], measured) << i;
    }
}

TEST(LearnedTest, WhatTheRefinerThrowsEndsIt) {
    EXPECT_THROW(learned_fast([](const RefinerInput&, std::span<float>) {
                     throw std::out_of_range("mine");
                 }),
                 std::out_of_range);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 2e9F})
        expect_parts(
            message_of<InputError>([&] {
                return learned_fast([&](const RefinerInput& input, std::span<float> refined) {
                    keep(input, refined);
                    refined[3] = bad;
                });
            }),
            {"refiner: ", "slot 0", "finite"});
}

TEST(LearnedTest, StillTextureReturnsWhereTheSamplesAroundExplainLess) {
    // A change that no sample contradicts alone: by a half to three standard deviations.
    const FluxVideo video = flat_video(16, kShape, 0.15F);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    const auto light = [&](float change) {
        Measurements m = measure(video, schedule);
        return *decode_learned({m, paper_noise(), kGoOn}, kShort,
                               [&](const RefinerInput& input, std::span<float> refined) {
                                   keep(input, refined);
                                   for (float& root : refined) root += change;
                               });
    };
    const FluxVideo estimate = light(0), little = light(0.002F), much = light(0.015F);
    int changed = 0;
    for (std::size_t i = 0; i < estimate.voxels(); ++i) {
        EXPECT_GT(little.data()[i], estimate.data()[i]);
        if (much.data()[i] > estimate.data()[i] + 1e-3F) ++changed;
    }
    EXPECT_LT(changed, static_cast<int>(estimate.voxels()) / 20);
}

TEST(LearnedTest, EachPlaneOfAMosaicIsRefined) {
    const FrameShape shape{.rows = 24, .cols = 28, .planes = 3};
    const FluxVideo video = moving_bar(shape);
    const Recorded recorded =
        record_mosaic(video, ColourFilter::kRggb,
                      random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1));
    const auto samples_of = [&] {
        return collect_measurements(recorded.header, recorded.packets, whole(video));
    };
    CollaborativeOptions options;
    options.mosaic.iterations = 4;
    Measurements for_best = samples_of(), for_learned = samples_of();
    int planes = 0;
    const auto count = [&](const RefinerInput& input, std::span<float> refined) {
        keep(input, refined);
        ++planes;
    };
    expect_near(*decode_learned({for_learned, paper_noise(), kGoOn}, options, count),
                *decode_collaborative(for_best, paper_noise(), options));
    EXPECT_EQ(planes, 3 * video.slots());
}

TEST(LearnedTest, NeedsWeights) {
    Measurements m = samples();
    EXPECT_NE(message_of<InputError>([&] {
                  return decode_learned({m, paper_noise(), kGoOn}, {}, {});
              }).find("decoder.model"),
              std::string::npos);
}

TEST(LearnedTest, StopsWhenToldTo) {
    Measurements m = samples();
    for (const double until : {0.2, 0.7}) {
        const ProgressCallback stop = [until](double done) { return done < until; };
        EXPECT_FALSE(decode_learned_fast({m, paper_noise(), stop}, {}, keep));
        EXPECT_FALSE(decode_learned({m, paper_noise(), stop}, kShort, keep));
    }
}

class WeightsTest : public testing::Test {
  protected:
    std::string file(int inputs, const std::string& version) {
        const auto bytes = safetensors_file(
            random_network({.inputs = inputs, .half = 8, .quarter = 8}, 1), version);
        const auto path = folder_ / "net.safetensors";
        write_text(path, std::string(bytes.begin(), bytes.end()));
        return path.string();
    }

    TemporaryFolder folder_;
};

TEST_F(WeightsTest, AreTheRefiner) {
    const std::string path = file(kRefinementInputs, std::string(kRefinementInputsName));
    const RefinementNetwork network = RefinementNetwork::read(path);
    std::vector<float> seen = random_values(kRefinementInputs * std::size_t{8} * 16, 0, 1, 3);
    seen[14 * std::size_t{8} * 16] = 0.2F;
    std::vector<float> expected(8 * 16), refined(8 * 16);
    network.refine(seen, 8, 16, expected);
    refinement_of(path)({seen, 8, 16}, refined);
    EXPECT_EQ(refined, expected);
    for (const float other : {0.002F, 1.3F}) {  // no read noise that the weights are for
        seen[14 * std::size_t{8} * 16] = other;
        refinement_of(path)({seen, 8, 16}, refined);
        EXPECT_TRUE(std::ranges::equal(refined, std::span(seen).first(refined.size())));
    }
    seen[14 * std::size_t{8} * 16] = -1;  // none
    network.refine(seen, 8, 16, expected);
    refinement_of(path)({seen, 8, 16}, refined);
    EXPECT_EQ(refined, expected);
}

TEST_F(WeightsTest, MustBeMadeForTheseInputs) {
    expect_parts(
        message_of<InputError>([&] { return refinement_of(file(kRefinementInputs, "1")); }),
        {"net.safetensors: ", "15 inputs of version \"1\"", "15 of version \"2\""});
    EXPECT_THROW((void)refinement_of(file(3, std::string(kRefinementInputsName))), InputError);
}

}  // namespace
}  // namespace stipple
