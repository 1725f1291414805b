#include "study/report/stream_samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "decoder/measurements.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"
#include "stream/stream_reader.h"
#include "tests/study/report/recorded_clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 24, .cols = 32, .planes = 3};
constexpr PixelArea kArea{.first_row = 5, .first_col = 7, .rows = 11, .cols = 13};
constexpr int kSlots = 20;

/// A stream, and its samples twice: as a report holds them and as the decoder takes them.
struct Samples {
    Samples(const SensorChoice& choice, FrameShape shape) {
        record_clip(folder / "a.stipple", choice, ramp(kSlots, shape));
        take(folder / "a.stipple");
    }
    /// Of a sensor that switches before a slot.
    Samples(const SensorChoice& first, const SensorChoice& later, int slot, FrameShape shape) {
        const SensorSetup setup = set_up_sensor(first, shape);
        StreamRecorder recorder(folder / "a.stipple", setup, {.may_switch = true});
        const FluxVideo video = ramp(kSlots, shape);
        for (int i = 0; i < kSlots; ++i) {
            if (i == slot) recorder.switch_to(set_up_sensor(later, shape));
            recorder.expose(video.frame(i));
        }
        recorder.finish();
        take(folder / "a.stipple");
    }

    void take(const std::filesystem::path& file) {
        StreamReader reader(file);
        reader.follow_switches();
        std::vector<SamplePacket> packets;
        for (SamplePacket packet; reader.next(packet);) packets.push_back(packet);
        StreamSamples samples(reader.header(), kArea);
        for (const SamplePacket& packet : packets) samples.add(packet);
        samples.finish();
        const auto colours = static_cast<std::size_t>(reader.header().shape.planes);
        json = samples.json();
        for (const PackedPlane& plane : samples.planes())
            planes[plane.id] = unpacked_plane(plane.text, plane.id.starts_with('d') ? colours : 1);
        const FrameShape decoded = decoded_shape(reader.header());
        measured = collect_measurements(
            reader.header(), packets,
            {.slots = kSlots,
             .first_row = kArea.first_row,
             .first_col = kArea.first_col,
             .shape = {.rows = kArea.rows, .cols = kArea.cols, .planes = decoded.planes}});
    }

    TemporaryFolder folder;
    nlohmann::ordered_json json;
    std::map<std::string, std::vector<std::uint16_t>> planes;
    Measurements measured;
};

/// The light and variance that the page computes of a DN (lightOfSample in page/report_data.js).
struct PageSample {
    bool saturated;
    double light;
    double variance;
};
PageSample page_sample(const nlohmann::ordered_json& response, int dn) {
    const bool saturated = dn >= response["saturated_dn"].get<int>();
    const double light =
        saturated ? response["bound"].get<double>()
                  : response["zero"].get<double>() + response["per_dn"].get<double>() * dn;
    return {saturated, light,
            response["dark_variance"].get<double>() +
                response["variance_per_light"].get<double>() * std::max(light, 0.0)};
}

/// Compares all samples of a stream in which each pixel has one DN for each of `planes` planes.
void expect_samples_of_the_decoder(const Samples& samples, int planes) {
    const int response_rows = samples.json["response_rows"];
    const int response_cols = samples.json["response_cols"];
    std::size_t compared = 0;
    for (int slot = 0; slot < kSlots; ++slot) {
        const auto kinds = samples.planes.find(fmt::format("k-{}", slot));
        if (kinds == samples.planes.end()) continue;
        auto dn = samples.planes.at(fmt::format("d-{}", slot)).begin();
        for (int pixel = 0; pixel < kArea.rows * kArea.cols; ++pixel) {
            const std::uint16_t kind = kinds->second[static_cast<std::size_t>(pixel)];
            if (kind == 0) continue;
            const auto& exposure = samples.json["exposures"][kind - 1U];
            const int row = (kArea.first_row + pixel / kArea.cols) % response_rows;
            const int col = (kArea.first_col + pixel % kArea.cols) % response_cols;
            const auto& response = samples.json["responses"][exposure["readout"].get<std::size_t>()]
                                               [static_cast<std::size_t>(row * response_cols + col)]
                                               [std::to_string(exposure["light_slots"].get<int>())];
            for (int plane = 0; plane < planes; ++plane, ++compared) {
                const PageSample sample = page_sample(response, *dn++);
                const auto voxel = static_cast<std::size_t>(
                    ((slot * planes + plane) * kArea.rows * kArea.cols) + pixel);
                const Measurements& m = samples.measured;
                ASSERT_TRUE((m.state[voxel] & Measurements::kLast) != 0);
                ASSERT_EQ((m.state[voxel] & Measurements::kSaturated) != 0, sample.saturated);
                // The decoder computes in float: 24 bits of the largest light, about 20.
                ASSERT_NEAR(static_cast<double>(m.sum[voxel]), sample.light, 4e-6);
                ASSERT_NEAR(static_cast<double>(m.variance[voxel]) / sample.variance, 1, 4e-6);
            }
        }
    }
    const auto is_last = [](std::uint8_t state) { return (state & Measurements::kLast) != 0; };
    EXPECT_EQ(compared,
              static_cast<std::size_t>(std::ranges::count_if(samples.measured.state, is_last)));
    EXPECT_GT(compared, 100U);
}

TEST(StreamSamplesTest, LightAndVarianceAreThoseOfTheDecoder) {
    expect_samples_of_the_decoder(Samples({}, kShape), 3);
}

TEST(StreamSamplesTest, PixelsWithResponsesOfTheirOwnToo) {
    expect_samples_of_the_decoder(Samples({.sensor = "nd_mosaic"}, {.rows = 24, .cols = 32}), 1);
}

TEST(StreamSamplesTest, DarkCurrentToo) {
    const SensorChoice warm{.sensor = "grasshopper", .settings = {"dark_current_e_per_s=4000"}};
    expect_samples_of_the_decoder(Samples(warm, {.rows = 24, .cols = 32}), 1);
}

TEST(StreamSamplesTest, AcrossASwitchOfScheduleAndReadoutToo) {
    const SensorChoice later{.schedule = "random", .settings = {"full_scale_e=3000"}, .seed = 4};
    const FrameShape shape{.rows = 24, .cols = 32};
    const Samples samples({.schedule = "tiled"}, later, 9, shape);
    EXPECT_EQ(samples.json["responses"].size(), 2U);
    expect_samples_of_the_decoder(samples, 1);
}

TEST(StreamSamplesTest, AnExposureHasItsOpenSlots) {
    const Samples samples({.schedule = "full4x"}, kShape);
    EXPECT_EQ(samples.json["exposures"],
              nlohmann::ordered_json::parse(
                  R"([{"span_slots":4,"light_slots":4,"open":[[0,4]],"readout":0}])"));
    EXPECT_EQ(samples.planes.size(), 2 * kSlots / 4);
}

TEST(StreamSamplesTest, TooManyPixelsThatDifferAreRefused) {
    const TemporaryFolder folder;
    record_clip(folder / "a.stipple", {}, ramp(2, kShape));
    StreamHeader header = StreamReader(folder / "a.stipple").header();
    header.calibration.tile = {
        .rows = 64, .cols = 65, .pixels = std::vector<CalibrationPixel>(64 * 65)};
    EXPECT_THROW(StreamSamples(header, kArea), InputError);
}

}  // namespace
}  // namespace stipple
