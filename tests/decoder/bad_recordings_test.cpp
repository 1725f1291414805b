// What no scene gives: each method must refuse it with a message, or deliver sane light.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "decoder/decode_options.h"
#include "decoder/reconstruct.h"
#include "decoder/schedule_check/schedule_shift.h"
#include "readout/schedules/full_schedule.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/stream_writer.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Frames, or the message of a refusal.
struct Outcome {
    std::vector<float> light;
    std::int64_t slots = 0;
    std::string refusal;
    StreamReport report;
};

class BadRecordingsTest : public testing::TestWithParam<NamedDecodeMethod> {
  protected:
    /// What fails does so in the first iterations.
    static DecodeOptions options() {
        DecodeOptions options{.method = GetParam().method};
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
        try {
            outcome.slots =
                decode(reader, options(), [&](std::int64_t, std::span<const float> frame) {
                    outcome.light.insert(outcome.light.end(), frame.begin(), frame.end());
                    return true;
                }).slots;
        } catch (const InputError& e) {
            outcome.refusal = e.what();
        }
        outcome.report = reader.report();
        return outcome;
    }
    /// Finite light, not negative, in as many slots; or a message.
    static void expect_sane(const Outcome& outcome, const Recorded& recorded) {
        if (!outcome.refusal.empty()) {
            EXPECT_GT(outcome.refusal.size(), 20U);
            return;
        }
        EXPECT_EQ(outcome.slots, static_cast<std::int64_t>(recorded.packets.size()));
        ASSERT_EQ(outcome.light.size(), recorded.packets.size() * recorded.header.shape.sites());
        for (const float light : outcome.light)
            ASSERT_TRUE(light >= 0 && light <= std::numeric_limits<float>::max()) << light;
    }
    void decode_sanely(const Recorded& recorded) const { expect_sane(decoded(recorded), recorded); }
};

FluxVideo flat(int slots, FrameShape shape, float light) {
    FluxVideo video(slots, shape);
    std::ranges::fill(video.data(), light);
    return video;
}

ExposureSchedule paper(FrameShape shape) {
    return random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
}

constexpr FrameShape kShape{17, 24, 1};

TEST_P(BadRecordingsTest, SensorsOfOneRowOrOneColumn) {
    for (const FrameShape shape : {FrameShape{1, 1, 1},
                                   {1, 40, 1},
                                   {40, 1, 1},
                                   {1, 33, 3},
                                   {33, 1, 3},
                                   {2, 2, 1},
                                   {3, 17, 1},
                                   {7, 40, 1},
                                   {40, 7, 1}})
        decode_sanely(record(random_video(20, shape, 1), paper(shape)));
}

TEST_P(BadRecordingsTest, RecordingsOfAFewSlots) {
    for (const int slots : {1, 2, 3, 4, 7})
        for (const ExposureSchedule& schedule : {paper(kShape), full_schedule(1, 1)})
            decode_sanely(record(random_video(slots, kShape, 1), schedule));
}

TEST_P(BadRecordingsTest, PixelsThatAreNeverRead) {
    const FluxVideo video = random_video(20, kShape, 1);
    decode_sanely(record(video, {1, 2, 3, {0, 1, 1}, {{0, 1}}}));  // each other column
    const Recorded never = record(video, {1, 1, 3, {0, 0}, {}});
    const Outcome outcome = decoded(never);
    expect_sane(outcome, never);
    for (const float light : outcome.light) EXPECT_EQ(light, 0);
}

TEST_P(BadRecordingsTest, AllSamplesDropped) {
    Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    for (SamplePacket& packet : recorded.packets) {
        packet.flags = SamplePacket::kDropped;
        packet.dn.clear();
    }
    const Outcome outcome = decoded(recorded);
    expect_sane(outcome, recorded);
    for (const float light : outcome.light) EXPECT_EQ(light, 0);
}

// Full scale is 2.0 of light in a sample: the light is known to be that or more, in exposures of
// one slot at least.
TEST_P(BadRecordingsTest, EverythingSaturated) {
    const Recorded recorded = record(flat(20, kShape, 50), paper(kShape));
    const Outcome outcome = decoded(recorded);
    expect_sane(outcome, recorded);
    double sum = 0;
    for (const float light : outcome.light) {
        EXPECT_LT(light, 100);
        sum += static_cast<double>(light);
    }
    EXPECT_GE(sum, 0.25 * static_cast<double>(outcome.light.size()));
}

TEST_P(BadRecordingsTest, Darkness) {
    const Recorded recorded = record(flat(20, kShape, 0), paper(kShape));
    const Outcome outcome = decoded(recorded);
    expect_sane(outcome, recorded);
    for (const float light : outcome.light) EXPECT_LT(light, 0.1);
}

TEST_P(BadRecordingsTest, NumbersThatAreNoPicture) {
    Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    std::mt19937 random(1);
    for (SamplePacket& packet : recorded.packets)
        for (std::uint16_t& dn : packet.dn) dn = static_cast<std::uint16_t>(random() >> 24U);
    decode_sanely(recorded);
}

TEST_P(BadRecordingsTest, AHeaderWhoseScheduleContradictsTheNumbersOfSamples) {
    const Recorded recorded = record(random_video(20, kShape, 1), paper(kShape));
    const Outcome outcome =
        decoded(recorded, random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 2));
    expect_sane(outcome, recorded);
    EXPECT_GE(outcome.report.missing_slots, 15);
    EXPECT_NE(outcome.report.damage.at(0).cause.find("not what is due"), std::string::npos);
}

TEST_P(BadRecordingsTest, AHeaderWhoseScheduleIsWrongUnnoticed) {
    const ExposureSchedule schedule = tiled_schedule(8, 8, kPaperExposureSlots, 1);
    const Recorded recorded = record(random_video(20, kShape, 1), schedule);
    expect_sane(decoded(recorded, shifted_schedule(schedule, {0, 3, 5})), recorded);
}

// The limits of the stream format, where squares leave the range of a float.
TEST_P(BadRecordingsTest, CalibrationsThatNoSensorHas) {
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
                decode_sanely(recorded);
            }
    Recorded recorded = honest;
    recorded.header.calibration.black_level_dn = 65535;
    decode_sanely(recorded);
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

INSTANTIATE_TEST_SUITE_P(Methods, BadRecordingsTest,
                         testing::ValuesIn(decode_methods().begin(), decode_methods().end()),
                         [](const auto& method) { return std::string(method.param.name); });

}  // namespace
}  // namespace stipple
