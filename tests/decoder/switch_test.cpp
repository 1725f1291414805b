// Emulator and decoder across a switch of the schedule.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"
#include "decoder/decode_method.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"
#include "stream/schedule_switch.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kArray{24, 30, 1};

SensorSetup setup_of(const ExposureSchedule& schedule, const SensorParams& params) {
    return {.params = params,
            .schedule = NamedSchedule{.name = "test", .source = {}, .schedule = schedule},
            .shape = kArray,
            .footage = kArray,
            .seed = 1};
}

ExposureSchedule paper(std::uint64_t seed) {
    return random_schedule(kArray.rows, kArray.cols, kPaperExposureSlots, seed);
}

ExposureSchedule gapped() {
    return {2,
            2,
            8,
            {0, 2, 3, 5, 7},
            {{0, 0b101}, {4, 0b11}, {2, 0b100111}, {7, 0b1}, {1, 0b1111}, {6, 0b11}, {1, 0b1}}};
}

/// A stream in which the sensor changes before each of some slots.
class SwitchedRecording {
  public:
    SwitchedRecording(const FluxVideo& video, const SensorSetup& first,
                      const std::map<int, SensorSetup>& later)
        : file_(folder_ / "clip.stipple") {
        StreamRecorder recorder(file_, first, {.may_switch = true});
        for (int slot = 0; slot < video.slots(); ++slot) {
            if (const auto next = later.find(slot); next != later.end())
                recorder.switch_to(next->second);
            recorder.expose(video.frame(slot));
        }
        recorder.finish();
    }

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] Recorded read() const {
        StreamReader reader(file_, ReadPolicy::kStrict);
        reader.follow_switches();
        std::vector<SamplePacket> packets;
        for (SamplePacket packet; reader.next(packet);) packets.push_back(packet);
        return {reader.header(), std::move(packets)};
    }

  private:
    const TemporaryFolder folder_;
    const std::filesystem::path file_;
};

/// Twice the electrons a DN, half the electrons of light, and other rounding.
SensorParams other_readout(SensorParams params = rounding_sensor()) {
    if (params.mode == SensorMode::kPhysical) params.physical.black_level_dn += 50;
    params.full_scale_e *= 2;
    params.photons_per_unit *= 0.5;
    params.rounding = Rounding::kFloor;
    return params;
}

/// With dark electrons in each open slot, 0.01 of light 1.
SensorParams dark_sensor() {
    SensorParams params = rounding_sensor();
    params.mode = SensorMode::kPhysical;
    params.physical.dark_current_e_per_s = 1e6;
    params.physical.black_level_dn = 20;
    return params;
}

/// So dark that exposures across a switch do not saturate.
FluxVideo dim(FluxVideo video) {
    for (int slot = 0; slot < video.slots(); ++slot)
        for (float& light : video.frame(slot)) light *= 0.25F;
    return video;
}

/// Of each exposure the sample less the light of its open slots, at most.
double largest_residual(const Measurements& m, const FluxVideo& video) {
    double largest = 0;
    for (std::size_t site = 0; site < m.shape.sites(); ++site) {
        double light = 0;
        for (int slot = 0; slot < m.slots; ++slot) {
            const std::size_t voxel = static_cast<std::size_t>(slot) * m.shape.sites() + site;
            if ((m.state[voxel] & Measurements::kFirst) != 0) light = 0;
            if ((m.state[voxel] & Measurements::kOpen) != 0)
                light += static_cast<double>(video.frame(slot)[site]);
            if ((m.state[voxel] & Measurements::kLast) != 0)
                largest = std::max(largest, std::abs(light - static_cast<double>(m.sum[voxel])));
        }
    }
    return largest;
}

TEST(SwitchTest, EachSampleIsTheLightOfTheSlotsThatTheDecoderTakesForIts) {
    const FluxVideo video = dim(random_video(70, kArray, 1));
    const std::vector<std::pair<SensorParams, std::array<ExposureSchedule, 3>>> cases{
        {rounding_sensor(), {paper(1), paper(2), gapped()}},
        {rounding_sensor(), {gapped(), paper(1), gapped()}},
        {dark_sensor(), {paper(1), gapped(), paper(2)}}};
    for (const auto& [params, schedules] : cases) {
        const SwitchedRecording recording(video, setup_of(schedules[0], params),
                                          {{3, setup_of(schedules[1], other_readout(params))},
                                           {26, setup_of(schedules[2], params)},
                                           {45, setup_of(schedules[0], other_readout(params))}});
        const Recorded read = recording.read();
        ASSERT_EQ(read.header.switches.size(), 3U);
        const Measurements m = collect_measurements(read.header, read.packets, whole(video));
        const auto lasts = std::ranges::count_if(
            m.state, [](unsigned state) { return (state & Measurements::kLast) != 0; });
        std::size_t samples = 0;
        for (const SamplePacket& packet : read.packets) samples += packet.dn.size();
        EXPECT_EQ(static_cast<std::size_t>(lasts), samples);
        // Half a DN, or one where it is twice as much light for half of the electrons.
        const Calibration c = calibration_at(read.header, 3);
        EXPECT_LT(largest_residual(m, video), 1.01 * c.gain_e_per_dn / c.electrons_per_unit);
    }
}

TEST(SwitchTest, WithoutGapsEachVoxelIsInOneExposure) {
    const FluxVideo video = random_video(60, kArray, 1);
    const SwitchedRecording recording(
        video, setup_of(paper(1), rounding_sensor()),
        {{20, setup_of(paper(2), rounding_sensor())}, {23, setup_of(paper(3), rounding_sensor())}});
    const Recorded read = recording.read();
    const Measurements m = collect_measurements(read.header, read.packets, whole(video));
    const std::size_t sites = kArray.sites();
    EXPECT_TRUE(std::all_of(m.state.begin() + static_cast<std::ptrdiff_t>(8 * sites),
                            m.state.end() - static_cast<std::ptrdiff_t>(16 * sites),
                            [](unsigned state) { return (state & Measurements::kOpen) != 0; }));
}

TEST(SwitchTest, AWindowHasTheSamplesOfTheWholeRecording) {
    const FluxVideo video = random_video(60, kArray, 1);
    const SwitchedRecording recording(video, setup_of(paper(1), rounding_sensor()),
                                      {{20, setup_of(paper(2), other_readout())}});
    const Recorded read = recording.read();
    const Measurements all = collect_measurements(read.header, read.packets, whole(video));
    VideoWindow window = whole(video);
    for (const int first : {12, 20, 25, 30}) {
        window.first_slot = first;
        window.slots = 60 - first;
        const Measurements m = collect_measurements(read.header, read.packets, window);
        for (std::size_t voxel = 0; voxel < m.voxels(); ++voxel) {
            if ((m.state[voxel] & Measurements::kLast) == 0) continue;
            ASSERT_EQ(m.sum[voxel],
                      all.sum[voxel + static_cast<std::size_t>(first) * kArray.sites()]);
        }
    }
}

/// A pattern that moves by a pixel in two slots.
FluxVideo moving_video(int slots) {
    FluxVideo video(slots, kArray);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < kArray.rows; ++row)
            for (int col = 0; col < kArray.cols; ++col)
                video.plane(slot, 0).row(row)[static_cast<std::size_t>(col)] = static_cast<float>(
                    0.5 + 0.3 * std::sin(0.5 * (col - 0.5 * slot)) * std::cos(0.4 * row));
    return video;
}

std::vector<double> errors(const std::filesystem::path& file, DecodeMethod method,
                           const FluxVideo& video) {
    StreamReader reader(file, ReadPolicy::kStrict);
    std::vector<double> errors;
    decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
        errors.push_back(mean_square(frame, video.frame(static_cast<int>(slot))));
        return true;
    });
    return errors;
}

double mean(const std::vector<double>& values, int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) sum += values[static_cast<std::size_t>(i)];
    return sum / (end - begin);
}

/// Around a switch exposures of 1, 2, 4 and 8 slots have up to 15, so the error may be larger
/// there: by a sixth at most with these methods. With wrong slots it is ten times as large.
void expect_no_seam(std::initializer_list<DecodeMethod> methods) {
    const FluxVideo video = dim(moving_video(96));
    const SwitchedRecording recording(video, setup_of(paper(1), rounding_sensor()),
                                      {{48, setup_of(paper(2), other_readout())}});
    for (const DecodeMethod method : methods) {
        const auto e = errors(recording.file(), method, video);
        ASSERT_EQ(e.size(), 96U);
        const double elsewhere = (mean(e, 16, 36) + mean(e, 60, 80)) / 2;
        EXPECT_LT(mean(e, 44, 52), 1.5 * elsewhere) << named(method).name;
    }
}

TEST(SwitchTest, AMovingSceneHasNoSeam) {
    expect_no_seam({DecodeMethod::kNaive, DecodeMethod::kLive, DecodeMethod::kFast});
}

TEST(SwitchTest, SlowMethodsHaveNoSeamEither) {
    expect_no_seam({DecodeMethod::kBest, DecodeMethod::kPortz2013, DecodeMethod::kReddy2011});
}

TEST(SwitchTest, AStaticSceneIsExactAcrossIt) {
    const FluxVideo one = dim(random_video(1, kArray, 3));
    FluxVideo video(80, kArray);
    for (int slot = 0; slot < 80; ++slot)
        std::ranges::copy(one.frame(0), video.frame(slot).begin());
    const SwitchedRecording recording(video, setup_of(paper(1), rounding_sensor()),
                                      {{37, setup_of(gapped(), other_readout())}});
    const auto e = errors(recording.file(), DecodeMethod::kNaive, video);
    const Calibration c = calibration_at(recording.read().header, 40);
    const double dn = c.gain_e_per_dn / c.electrons_per_unit;
    EXPECT_LT(*std::max_element(e.begin(), e.end()), dn * dn);
}

TEST(SwitchTest, FollowedAndInPartsTheFramesAreTheSame) {
    const FluxVideo video = moving_video(150);
    const SwitchedRecording recording(
        video, setup_of(paper(1), rounding_sensor()),
        {{40, setup_of(gapped(), rounding_sensor())}, {100, setup_of(paper(2), other_readout())}});
    const auto frames = [&](StreamReader reader, std::int64_t first) {
        std::vector<float> all;
        DecodeOptions options{.method = DecodeMethod::kNaive};
        options.first_slot = first;
        decode(reader, options, [&](std::int64_t, std::span<const float> frame) {
            all.insert(all.end(), frame.begin(), frame.end());
            return true;
        });
        return all;
    };
    const auto whole = frames(StreamReader(recording.file()), 0);
    EXPECT_EQ(frames(StreamReader(recording.file(), ReadPolicy::kTolerant,
                                  [](std::uint64_t) { return false; }),
                     0),
              whole);
    for (const std::int64_t first : {48, 96}) {
        const auto part = frames(StreamReader(recording.file()), first);
        EXPECT_TRUE(std::equal(part.begin(), part.end(),
                               whole.end() - static_cast<std::ptrdiff_t>(part.size())));
    }
}

TEST(SwitchTest, AMethodThatAsksForOneScheduleRefuses) {
    const FluxVideo video = moving_video(60);
    const ExposureSchedule every{1, 1, 1, {0, 1}, {{0, 1}}};
    const SwitchedRecording recording(video, setup_of(every, rounding_sensor()),
                                      {{30, setup_of(paper(2), rounding_sensor())}});
    for (const NamedDecodeMethod& method : decode_methods()) {
        if (method.check_schedule == nullptr) continue;
        StreamReader reader(recording.file());
        const auto message = message_of<InputError>([&] {
            return decode(reader, method.method,
                          [](std::int64_t, std::span<const float>) { return true; });
        });
        EXPECT_FALSE(message.empty()) << method.name;
    }
}

TEST(SwitchTest, TheEmulatorRefusesWhatIsNotModelled) {
    const FluxVideo video = moving_video(40);
    const SensorSetup first = setup_of(paper(1), rounding_sensor());
    const auto refusal = [&](const SensorSetup& next) {
        return message_of<InputError>([&] {
            return SwitchedRecording(video, first, {{30, next}}).file();
        });
    };
    SensorSetup next = first;
    next.params.bit_depth = 12;
    expect_parts(refusal(next), {"switch at slot 30", "only schedule, seed"});
    next = first;
    next.timing.emplace();
    expect_parts(refusal(next), {"switch at slot 30", "may change"});
    next.overrun = OverrunPolicy::kDrop;
    expect_parts(refusal(next), {"drops late rows"});
    next = first;
    next.schedule.schedule = {1, 1, 60, {0, 1}, {{30, open_without_gap(60)}}};
    expect_parts(refusal(next), {"switch at slot 30", "has an exposure of"});
}

}  // namespace
}  // namespace stipple
