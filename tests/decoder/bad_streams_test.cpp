// What no scene gives: each method decodes it to light that its samples can mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "decoder/decode_options.h"
#include "decoder/reconstruct.h"
#include "decoder/schedule_check/schedule_check.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/stream_writer.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

struct Outcome {
    std::vector<float> light;
    std::int64_t slots = 0;
    StreamReport report;
};

/// Full scale of a sample is 2.0 of light in one slot; the priors may overshoot, those of other
/// cameras, made for samples of equal length, further.
constexpr float kBrightest = 2.6F;

bool of_other_cameras(DecodeMethod method) {
    return method == DecodeMethod::kReddy2011 || method == DecodeMethod::kHitomi2011;
}

class BadStreamsTest : public testing::TestWithParam<NamedDecodeMethod> {
  protected:
    /// What fails does so in the first iterations.
    static DecodeOptions options() {
        DecodeOptions options{.method = GetParam().method};
        options.hitomi2011.dictionary = cosine_dictionary({.slots = 8, .side_px = 4}, 3);
        options.plug_and_play.denoiser = [](const auto&, bool) -> Denoiser {
            return [](const DenoiserInput& input, FluxVideo& result) { result = input.noisy; };
        };
        options.learned.refine = [](const RefinerInput& input, std::span<float> refined) {
            std::ranges::copy(input.inputs.first(refined.size()), refined.begin());
        };
        options.reddy2011.first_iterations = 10;
        options.reddy2011.rounds = 2;
        options.reddy2011.iterations = 5;
        options.portz2013.stage1.admm.iterations = 2;
        options.portz2013.stage2.admm.iterations = 2;
        options.portz2013.stage1.max_matches = 3;
        options.portz2013.stage2.max_matches = 3;
        return options;
    }
    /// Writes what the sensor made of it, under a header that may say something else.
    [[nodiscard]] Outcome decoded(const Recorded& recorded,
                                  const std::optional<ExposureSchedule>& stated = {}) const {
        const TemporaryFolder folder;
        StreamWriter writer(folder / "clip.stipple", recorded.header);
        for (const SamplePacket& packet : recorded.packets) writer.write(packet);
        writer.finish();
        StreamReader reader(folder / "clip.stipple");
        if (stated) reader.use_schedule(*stated);
        Outcome outcome;
        outcome.slots = decode(reader, options(), [&](std::int64_t, std::span<const float> frame) {
                            outcome.light.insert(outcome.light.end(), frame.begin(), frame.end());
                            return true;
                        }).slots;
        outcome.report = reader.report();
        return outcome;
    }
    /// As many slots as were recorded, of light from 0 to `brightest`.
    static void expect_light(const Outcome& outcome, const Recorded& recorded,
                             float brightest = kBrightest) {
        // Sums of patterns overshoot; but no slot has more light than all of an exposure.
        if (brightest == kBrightest && of_other_cameras(GetParam().method)) brightest *= 8;
        // To a bound of 2.0 come the residuals of the pixels around.
        if (brightest == kBrightest && GetParam().method == DecodeMethod::kLive) brightest = 4;
        // The denoiser here changes nothing, so that no light is the square of a rounded root.
        if (GetParam().method == DecodeMethod::kPlugAndPlay) brightest += 1e-9F;
        EXPECT_EQ(outcome.slots, static_cast<std::int64_t>(recorded.packets.size()));
        ASSERT_EQ(outcome.light.size(), recorded.packets.size() * recorded.header.shape.sites());
        for (const float light : outcome.light)
            ASSERT_TRUE(light >= 0 && light <= brightest) << light;
    }
    void expect_decoded(const Recorded& recorded, float brightest = kBrightest) const {
        expect_light(decoded(recorded), recorded, brightest);
    }
};

ExposureSchedule paper(FrameShape shape) {
    return random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
}

constexpr FrameShape kShape{17, 24, 1};

TEST_P(BadStreamsTest, ASensorOfOneRowOrColumnIsDecoded) {
    for (const FrameShape shape : {FrameShape{1, 1, 1},
                                   {1, 40, 1},
                                   {40, 1, 1},
                                   {1, 33, 3},
                                   {33, 1, 3},
                                   {2, 2, 1},
                                   {3, 17, 1},
                                   {7, 40, 1},
                                   {40, 7, 1}})
        expect_decoded(record(random_video(20, shape, 1), paper(shape)));
}

TEST_P(BadStreamsTest, AFewSlotsAreDecoded) {
    for (const int slots : {1, 2, 3, 4, 7})
        for (const ExposureSchedule& schedule : {paper(kShape), full_schedule(1, 1)})
            expect_decoded(record(random_video(slots, kShape, 1), schedule));
}

TEST_P(BadStreamsTest, PixelsThatAreNeverReadAreDecoded) {
    const FluxVideo video = random_video(20, kShape, 1);
    expect_decoded(record(video, {1, 2, 3, {0, 1, 1}, {{0, 1}}}));  // each other column
    expect_decoded(record(video, {1, 1, 3, {0, 0}, {}}), 0);
}

TEST_P(BadStreamsTest, WithoutSamplesFramesAreBlack) {
    Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    for (SamplePacket& packet : recorded.packets) {
        packet.flags = SamplePacket::kDropped;
        packet.dn.clear();
    }
    expect_decoded(recorded, 0);
}

// Full scale is 2.0 of light in a sample: the light is known to be that or more, in exposures of
// one slot at least.
TEST_P(BadStreamsTest, SaturatedFramesAreBright) {
    const Recorded recorded = record(flat_video(20, kShape, 50), paper(kShape));
    const Outcome outcome = decoded(recorded);
    expect_light(outcome, recorded);
    double sum = 0;
    for (const float light : outcome.light) sum += static_cast<double>(light);
    // Ends of clips say less. hitomi2011 takes a bound that it would violate for exact.
    const double least = GetParam().method == DecodeMethod::kHitomi2011 ? 1.3 : 1.8;
    EXPECT_GE(sum, least * static_cast<double>(outcome.light.size()));
}

TEST_P(BadStreamsTest, DarkFramesStayDark) {
    const Recorded recorded = record(flat_video(20, kShape, 0), paper(kShape));
    expect_decoded(recorded, 0.04F);  // four standard deviations of the read noise
}

TEST_P(BadStreamsTest, NoiseIsDecoded) {
    Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    std::mt19937 random(1);
    for (SamplePacket& packet : recorded.packets)
        for (std::uint16_t& dn : packet.dn) dn = static_cast<std::uint16_t>(random() >> 24U);
    expect_decoded(recorded);
}

TEST_P(BadStreamsTest, AScheduleThatTheSamplesContradictCostsSlots) {
    const Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    const Outcome outcome =
        decoded(recorded, random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 2));
    expect_light(outcome, recorded, 0);
    EXPECT_GE(outcome.report.missing_slots, 15);
    EXPECT_GE(outcome.report.unexpected_packets, 15U);
}

TEST_P(BadStreamsTest, AWrongScheduleThatFitsTheCountsIsDecoded) {
    const ExposureSchedule schedule = tiled_schedule(8, 8, kPaperExposureSlots, 1);
    const Recorded recorded = record(random_video(20, kShape, 1), schedule);
    expect_light(decoded(recorded, shifted_schedule(schedule, {0, 3, 5})), recorded);
}

// The limits of the stream format, where squares leave the range of a float.
TEST_P(BadStreamsTest, CalibrationsAtTheLimitsGiveFiniteLight) {
    const Recorded honest = record(random_video(10, {16, 16, 1}, 1), paper({16, 16, 1}));
    for (const double gain : {1e-12, 1e12})
        for (const double noise : {0.0, 1e12})
            for (const double unit : {1e-12, 1e12}) {
                Recorded recorded = honest;
                Calibration& calibration = recorded.header.calibration;
                calibration.gain_e_per_dn = gain;
                calibration.read_noise_e = noise;
                calibration.electrons_per_unit = unit;
                SCOPED_TRACE(testing::Message() << gain << ' ' << noise << ' ' << unit);
                expect_decoded(recorded, std::numeric_limits<float>::max());
            }
    Recorded recorded = honest;
    recorded.header.calibration.black_level_dn = 65535;  // all samples say less than no light
    // See options(); the methods of other cameras fit negative samples by patterns, which
    // overshoot.
    const bool is_zero =
        GetParam().method != DecodeMethod::kPortz2013 && !of_other_cameras(GetParam().method);
    expect_decoded(recorded, is_zero ? 0 : std::numeric_limits<float>::max());
}

// A prior that is switched off divides by no weight.
TEST(FastTest, WeightsMayBeZero) {
    const Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    const TemporaryFolder folder;
    StreamWriter writer(folder / "clip.stipple", recorded.header);
    for (const SamplePacket& packet : recorded.packets) writer.write(packet);
    writer.finish();
    for (const float spatial : {0.0F, 3.0F})
        for (const float temporal : {0.0F, 3.0F}) {
            DecodeOptions options{.method = DecodeMethod::kFast};
            for (TotalVariationOptions* tv :
                 {&options.fast.static_tv, &options.fast.along_motion}) {
                tv->spatial_weight = spatial;
                tv->temporal_weight = temporal;
            }
            StreamReader reader(folder / "clip.stipple");
            decode(reader, options, [&](std::int64_t, std::span<const float> frame) {
                EXPECT_TRUE(std::ranges::all_of(frame, [](float x) { return x >= 0 && x < 10; }));
                return true;
            });
        }
}

/// Those of conventional cameras are tested in rivals/frame_decoding_test.cpp.
std::vector<NamedDecodeMethod> methods_of_coded_streams() {
    std::vector<NamedDecodeMethod> methods;
    std::ranges::copy_if(decode_methods(), std::back_inserter(methods),
                         [](const auto& method) { return method.check_schedule == nullptr; });
    return methods;
}

INSTANTIATE_TEST_SUITE_P(Methods, BadStreamsTest, testing::ValuesIn(methods_of_coded_streams()),
                         [](const auto& method) { return std::string(method.param.name); });

}  // namespace
}  // namespace stipple
