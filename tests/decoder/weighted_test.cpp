// Exposures behind a grey mask: each sample is a weighted sum of the slots of its pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "decoder/decode_method.h"
#include "decoder/decode_options.h"
#include "decoder/frame_exposures.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/portz2013/patch_distance.h"
#include "decoder/reconstruct.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr DecodeMethod kMethods[] = {DecodeMethod::kNaive,     DecodeMethod::kLive,
                                     DecodeMethod::kFast,      DecodeMethod::kBest,
                                     DecodeMethod::kPortz2013, DecodeMethod::kReddy2011,
                                     DecodeMethod::kHitomi2011};
constexpr FrameShape kShape{.rows = 16, .cols = 20, .planes = 1};

/// The masks of 8 slots of a coded aperture: every pixel open in every slot, in some greys.
ExposureSchedule grey_masks(std::uint32_t seed) {
    const auto pixels = static_cast<std::uint32_t>(kShape.pixels());
    std::vector<std::uint32_t> first(pixels + 1);
    for (std::uint32_t i = 0; i <= pixels; ++i) first[i] = i;
    return weighted_schedule(
        {kShape.rows, kShape.cols, 8, first, std::vector<Exposure>(pixels, {0, 0xFF})}, seed);
}

/// Without noise but rounding to 16 bits: a sample is exact to 8 / 65535 / 2.
SensorParams exact_sensor() {
    SensorParams params;
    params.shot_noise = false;
    params.read_noise_e = 0;
    params.photons_per_unit = 5e5;
    params.full_scale_e = 6.5e6;  // 13 of light
    params.full_well_e = 6.5e6;
    params.bit_depth = 16;
    return params;
}

/// The defaults; of portz2013, which would take long, with a smaller window.
DecodeOptions options_of(DecodeMethod method) {
    DecodeOptions options{.method = method};
    options.hitomi2011.dictionary = cosine_dictionary({.slots = 8, .side_px = 4}, 3);
    options.portz2013.stage1.search.window_px = 4;
    options.portz2013.stage1.search.window_slots = 2;
    options.portz2013.stage2.search.window_px = 4;
    options.portz2013.stage2.admm.iterations = 10;
    return options;
}

FluxVideo decoded(const FluxVideo& video, const ExposureSchedule& schedule, DecodeMethod method,
                  bool unit_weights = false) {
    const Recorded recorded = record(video, schedule, exact_sensor());
    Measurements m = collect_measurements(recorded.header, recorded.packets, whole(video));
    if (unit_weights) m.weight.assign(m.voxels(), 1.0F);
    return *decode_block(std::move(m), recorded.header.calibration, options_of(method));
}

class WeightedDecodeTest : public testing::TestWithParam<DecodeMethod> {};

TEST_P(WeightedDecodeTest, AConstantSceneIsExact) {
    FluxVideo video(24, kShape);
    std::ranges::fill(video.data(), 0.4F);
    const FluxVideo x = decoded(video, grey_masks(3), GetParam());
    // A sample is exact to 1e-4 of light; its weights have a sum of 2 or more, so a slot is exact
    // to 5e-5. `best` clips nothing at this light.
    for (const float light : x.data()) ASSERT_NEAR(light, 0.4F, 2e-4F);
}

TEST_P(WeightedDecodeTest, WeightsOfOneGiveTheBitsOfNoWeights) {
    const FluxVideo video = random_video(24, kShape, 1);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 2);
    const FluxVideo plain = decoded(video, schedule, GetParam());
    const FluxVideo weighted = decoded(video, schedule, GetParam(), true);
    EXPECT_TRUE(std::ranges::equal(weighted.data(), plain.data()));
}

std::string name_of_case(const testing::TestParamInfo<DecodeMethod>& info) {
    return std::string(named(info.param).name);
}

INSTANTIATE_TEST_SUITE_P(Methods, WeightedDecodeTest, testing::ValuesIn(kMethods), name_of_case);

TEST(WeightedMeasurementsTest, EachVoxelHasTheWeightOfItsSlotAndPixel) {
    const ExposureSchedule schedule = grey_masks(5);
    Recorded recorded = record(random_video(19, kShape, 1), schedule, exact_sensor());
    VideoWindow window{.first_slot = 5,
                       .slots = 14,
                       .first_row = 3,
                       .first_col = 4,
                       .shape = {.rows = 7, .cols = 9, .planes = 1}};
    const Measurements m = collect_measurements(recorded.header, recorded.packets, window);
    std::size_t open = 0;
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        const int slot = static_cast<int>(i / 63), row = static_cast<int>(i % 63 / 9);
        const int col = static_cast<int>(i % 9);
        const bool observed = (m.state[i] & Measurements::kOpen) != 0;
        open += observed ? 1 : 0;
        EXPECT_EQ(m.weight[i], observed ? schedule.weight((slot + 5) % 8, row + 3, col + 4) : 1.0F);
    }
    EXPECT_EQ(open, 8 * 63U);  // slots 8 to 15: the only whole measurement in the window
}

TEST(WeightedMeasurementsTest, AStreamWithoutWeightsTakesNoMemoryForThem) {
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 2);
    EXPECT_TRUE(measure(random_video(16, kShape, 1), schedule).weight.empty());
}

TEST(WeightedMeasurementsTest, AGreyPixelAmongBrightOnesIsNoDefect) {
    // Light 1 everywhere; the pixel in the middle sees 0.002 of it, which the noise hides.
    std::vector<HandSample> samples;
    for (std::size_t site = 0; site < 9; ++site)
        for (int slot = 0; slot < 10; slot += 2)
            samples.push_back({.site = site,
                               .first_slot = slot,
                               .open_slots = 0b11,
                               .light = site == 4 ? 2 * 0.002F : 2});
    const Measurements plain = hand_made(10, {.rows = 3, .cols = 3, .planes = 1}, samples);
    Measurements weighted = plain;
    weighted.weight.assign(plain.voxels(), 1.0F);
    for (std::size_t i = 4; i < plain.voxels(); i += 9) weighted.weight[i] = 0.002F;
    EXPECT_EQ(mask_defects(weighted), 0U);
    Measurements unweighted = plain;
    EXPECT_EQ(mask_defects(unweighted), 1U);
}

TEST(WeightedMeasurementsTest, TheNaiveEstimateIsTheSampleByItsWeights) {
    Measurements m = hand_made(3, kSite, {{.open_slots = 0b111, .light = 2}});
    m.weight = {0.5F, 0.25F, 0.25F};
    const FluxVideo x = nearest_samples(m);
    for (const float light : x.data()) EXPECT_EQ(light, 2.0F);
}

TEST(WeightedMeasurementsTest, SharedGreyMasksAreNotTakenForFramesOfAConventionalCamera) {
    Measurements m = hand_made(
        4, kSite,
        {{.open_slots = 0b11, .light = 2}, {.first_slot = 2, .open_slots = 0b11, .light = 2}});
    EXPECT_TRUE(frame_exposures(m).has_value());
    m.weight.assign(4, 0.5F);
    EXPECT_FALSE(frame_exposures(m).has_value());
}

TEST(WeightedPatchDistanceTest, PatchesOfTheSameLightAreEqualWhateverTheirWeights) {
    // Light 2 in all slots; site 0 has one exposure of 4 slots, site 1 two of 2 slots.
    constexpr FrameShape kPair{.rows = 1, .cols = 2, .planes = 1};
    Measurements m =
        hand_made(4, kPair,
                  {{.open_slots = 0b1111, .light = 2 * 2.0F},
                   {.site = 1, .open_slots = 0b11, .light = 2 * 0.75F},
                   {.site = 1, .first_slot = 2, .open_slots = 0b11, .light = 2 * 1.5F}});
    m.weight = {0.25F, 0.5F, 0.5F, 0.25F, 0.5F, 0.5F, 0.75F, 1.0F};
    const SampleDifference equal = compare_samples(ExposureTable(m), {0, 0}, {1, 0}, 4);
    EXPECT_EQ(equal.cover, 4);
    EXPECT_NEAR(equal.error, 0, 1e-12);  // the square of a rounding of 1e-7 of 4
    // Site 0 is the target, with the weights 0.25 + 0.5 and 0.5 + 0.75 in the two samples of site
    // 1, whose weights have the sums 0.75 and 1.5: the weight is 4 / (1 + 1 + (1.25 / 1.5)^2).
    EXPECT_NEAR(equal.weight, 4 / (2 + 1.5625 / 2.25), 1e-6);
}

TEST(WeightedScheduleTest, RefusesWeightsThatItsExposuresDoNotHave) {
    ExposureSchedule schedule(1, 2, 2, {0, 1, 2}, {{0, 0b11}, {1, 0b1}});
    const auto problem = [&](std::vector<float> weights) {
        return message_of<InputError>([&] { schedule.set_weights(std::move(weights)); });
    };
    expect_parts(problem({1, 0, 1}), {"3 weights", "1 x 2 pixels and 2 slots"});
    expect_parts(problem({1, 0.5F, 1, 1}), {"pixel (0, 1) slot 0", "0.5", "closed slot"});
    for (const float bad : {0.0F, -1.0F, 1e-7F, 2e6F, std::nanf(""), INFINITY})
        expect_parts(problem({1, 0, bad, 1}), {"pixel (0, 0) slot 1", "open slot", "2^-20..2^20"});
    EXPECT_FALSE(schedule.weighted());
    schedule.set_weights({1, 0, 1, 1});
    EXPECT_FALSE(schedule.weighted()) << "weights of 1 are none";
    schedule.set_weights({0.5F, 0, 1, 2});
    EXPECT_EQ(schedule.weight(1, 0, 1), 2);
    EXPECT_EQ(schedule.light_slots(0, 0, schedule.exposures(0, 0)[0]), 1.5);
    EXPECT_EQ(schedule.light_throughput(), 3.5 / 4);
    EXPECT_FALSE(schedule.gapless());
}

// A sample is Poisson of the weighted light, plus read noise, in DN of 2000 / 255 electrons.
TEST(WeightedEmulationTest, PhotonsOfTheWeightedLightAreCounted) {
    ExposureSchedule schedule(1, 1, 2, {0, 1}, {{0, 0b11}});
    schedule.set_weights({0.25F, 0.5F});
    constexpr FrameShape kField{.rows = 100, .cols = 100, .planes = 1};
    FluxVideo video(2, kField);
    std::ranges::fill(video.frame(0), 0.8F);
    std::ranges::fill(video.frame(1), 1.2F);
    const Recorded recorded = record(video, schedule);
    const auto& dn = recorded.packets.back().dn;
    ASSERT_EQ(dn.size(), kField.pixels());
    double sum = 0, squares = 0;
    for (const double value : dn) {
        sum += value;
        squares += value * value;
    }
    const double n = static_cast<double>(dn.size()), k = 255.0 / 2000;
    const double electrons = 1000 * (0.25 * 0.8 + 0.5 * 1.2);
    const double variance = k * k * (electrons + 100) + 1.0 / 12;
    EXPECT_NEAR(sum / n, k * electrons, 5 * std::sqrt(variance / n));
    // A variance of n normal values has the relative standard error sqrt(2 / n).
    EXPECT_NEAR(squares / n - sum / n * (sum / n), variance, 5 * variance * std::sqrt(2 / n));
}

}  // namespace
}  // namespace stipple
