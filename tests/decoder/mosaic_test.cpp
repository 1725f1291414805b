// Streams of a colour filter array, from samples to RGB.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "decoder/hitomi2011/hitomi2011.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/reconstruct.h"
#include "decoder/reddy2011/reddy2011.h"
#include "readout/schedules/random_codes.h"
#include "stream/stream_writer.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr ColourFilter kFilters[] = {ColourFilter::kRggb, ColourFilter::kGrbg, ColourFilter::kGbrg,
                                     ColourFilter::kBggr};

FluxVideo constant(int slots, FrameShape shape, const std::vector<float>& colour) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (std::size_t i = 0; i < shape.sites(); ++i)
            video.frame(slot)[i] = colour[i / shape.pixels()];
    return video;
}

FluxVideo decode_file(const std::filesystem::path& file, DecodeMethod method) {
    StreamReader reader(file);
    FluxVideo video(static_cast<int>(reader.slots().value()), decoded_shape(reader.header()));
    decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
        std::ranges::copy(frame, video.frame(static_cast<int>(slot)).begin());
        return true;
    });
    return video;
}

FluxVideo decode_mosaic(const Recorded& recorded, DecodeMethod method) {
    const TemporaryFolder folder;
    StreamWriter writer(folder / "clip.stipple", recorded.header);
    for (const SamplePacket& packet : recorded.packets) writer.write(packet);
    writer.finish();
    return decode_file(folder / "clip.stipple", method);
}

// The samples are those of a mono sensor, each in the plane that the filter's name says.
void expect_planes_of_name(ColourFilter cfa, const VideoWindow& window) {
    const FluxVideo video = random_video(30, {11, 14, 3}, 5);
    const Recorded mosaic =
        record_mosaic(video, cfa, random_schedule(11, 14, kPaperExposureSlots, 3));
    Recorded mono = mosaic;
    mono.header.cfa = ColourFilter::kNone;
    VideoWindow mono_window = window;
    mono_window.shape.planes = 1;
    const Measurements m = collect_measurements(mosaic.header, mosaic.packets, window);
    const Measurements expected = collect_measurements(mono.header, mono.packets, mono_window);
    const std::size_t pixels = window.shape.pixels();
    const auto cols = static_cast<std::size_t>(window.shape.cols);
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        const std::size_t row = i % pixels / cols + static_cast<std::size_t>(window.first_row);
        const std::size_t col = i % cols + static_cast<std::size_t>(window.first_col);
        const char letter = name_of(cfa)[row % 2 * 2 + col % 2];
        const bool seen = std::string_view("rgb").find(letter) == i / pixels % 3;
        const std::size_t same = i / (3 * pixels) * pixels + i % pixels;
        ASSERT_EQ(m.state[i], seen ? expected.state[same] : 0) << name_of(cfa) << ' ' << i;
        ASSERT_EQ(m.sum[i], seen ? expected.sum[same] : 0);
        ASSERT_EQ(m.variance[i], seen ? expected.variance[same] : 0);
    }
}

TEST(MosaicTest, EachPixelIsOpenInThePlaneOfItsFilterOnly) {
    for (const ColourFilter cfa : kFilters) {
        expect_planes_of_name(cfa, {0, 30, 0, 0, {11, 14, 3}});
        expect_planes_of_name(cfa, {4, 20, 3, 5, {7, 6, 3}});  // begins in the midst of a cell
        expect_planes_of_name(cfa, {4, 20, 2, 1, {8, 5, 3}});
    }
}

// Without noise light is off by half a DN, 0.004, in exposures of one slot at most.
TEST(MosaicTest, ALastingColourComesBackInEveryPixelByEveryMethod) {
    const FrameShape shape{18, 21, 3};
    const std::vector<float> colour{0.15F, 0.4F, 0.25F};
    const FluxVideo video = constant(45, shape, colour);
    const ExposureSchedule schedule = random_schedule(18, 21, kPaperExposureSlots, 1);
    for (const ColourFilter cfa : kFilters)
        for (const DecodeMethod method :
             {DecodeMethod::kNaive, DecodeMethod::kLive, DecodeMethod::kFast}) {
            const FluxVideo x = decode_mosaic(
                record_mosaic(video, cfa, schedule, {.read_noise_e = 0, .shot_noise = false}),
                method);
            for (std::size_t i = 8 * shape.sites(); i < 37 * shape.sites(); ++i)
                ASSERT_NEAR(x.data()[i], video.data()[i], 0.005) << name_of(cfa) << ' ' << i;
        }
}

TEST(MosaicTest, ColoursThatNoPixelSeesAreTakenToBeGrey) {
    // A row of rggb has no blue, a single pixel of bggr nothing else.
    for (const auto& [cfa, shape] : {std::pair{ColourFilter::kRggb, FrameShape{1, 9, 3}},
                                     std::pair{ColourFilter::kBggr, FrameShape{1, 1, 3}}})
        for (const DecodeMethod method :
             {DecodeMethod::kNaive, DecodeMethod::kLive, DecodeMethod::kFast}) {
            const FluxVideo x =
                decode_mosaic(record_mosaic(constant(40, shape, {0.3F, 0.3F, 0.3F}), cfa,
                                            random_schedule(1, 9, kPaperExposureSlots, 1),
                                            {.read_noise_e = 0, .shot_noise = false}),
                              method);
            for (std::size_t i = 8 * shape.sites(); i < 32 * shape.sites(); ++i)
                ASSERT_NEAR(x.data()[i], 0.3, 0.005) << shape.cols << ' ' << i;
        }
}

TEST(MosaicTest, FramesOfAnySizeDecodeToLight) {
    for (const ColourFilter cfa : kFilters)
        for (const FrameShape shape :
             {FrameShape{1, 1, 3}, FrameShape{1, 8, 3}, FrameShape{7, 1, 3}, FrameShape{2, 2, 3},
              FrameShape{17, 19, 3}}) {
            const FluxVideo video = random_video(30, shape, 1);
            const Recorded recorded = record_mosaic(
                video, cfa, random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1));
            for (const DecodeMethod method :
                 {DecodeMethod::kNaive, DecodeMethod::kLive, DecodeMethod::kFast}) {
                const FluxVideo x = decode_mosaic(recorded, method);
                ASSERT_EQ(x.shape(), shape);
                EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v >= 0 && v < 3; }))
                    << name_of(cfa) << ' ' << shape.rows << ' ' << shape.cols;
            }
        }
}

/// Mean squared error without the first and last 8 slots.
double error_of(const FluxVideo& x, const FluxVideo& truth) {
    double sum = 0;
    const std::size_t end = x.voxels() - 8 * x.shape().sites();
    const std::size_t begin = 8 * x.shape().sites();
    for (std::size_t i = begin; i < end; ++i) {
        const double error =
            static_cast<double>(x.data()[i]) - static_cast<double>(truth.data()[i]);
        sum += error * error;
    }
    return sum / static_cast<double>(end - begin);
}

// Without colour a mosaic says as much as a mono sensor, which need not find out that it is grey:
// at most 3 dB more error, in each plane, and far less than a bilinear start.
TEST(MosaicTest, AGreySceneIsNearlyAsGoodAsThatOfAMonoSensor) {
    const FrameShape shape{48, 64, 3};
    FluxVideo grey(40, shape);
    FluxVideo mono(40, {48, 64, 1});
    for (int slot = 0; slot < 40; ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col) {
                const int x = col - 10 - slot;
                const int y = row - 24;
                const int wall = 5 + col / 8 + 4 * ((row / 9 + col / 9) % 2);
                const float light = static_cast<float>(x * x + y * y < 100 ? 36 : wall) / 64;
                mono.plane(slot, 0)(row, col) = light;
                for (int plane = 0; plane < 3; ++plane) grey.plane(slot, plane)(row, col) = light;
            }
    const ExposureSchedule schedule = random_schedule(48, 64, kPaperExposureSlots, 1);
    Recorded one = record_mosaic(grey, ColourFilter::kRggb, schedule);
    const FluxVideo x = decode_mosaic(one, DecodeMethod::kFast);
    const FluxVideo start = decode_mosaic(one, DecodeMethod::kNaive);
    one.header.cfa = ColourFilter::kNone;
    const double expected = error_of(decode_mosaic(one, DecodeMethod::kFast), mono);
    expect_quality("beside_mono", gain_db(error_of(x, grey), expected), -2.58);
    expect_quality("beside_start", gain_db(error_of(x, grey), error_of(start, grey)), 8.39);
}

using Colour = std::array<float, 3>;

/// At rest: grey lines on dark ground, and a red card with a pale frame; before it a green disc
/// that moves by a pixel a slot.
Colour cards_on_lines(float slot, float row, float col) {
    const auto distance = [](float a, float b) { return std::abs(a - b); };
    const float edge = std::max(distance(row, 15), distance(col, 20));
    const float x = col - slot;
    const float y = row - 29;
    if (x * x + y * y < 25) return {0.1F, 0.4F, 0.2F};
    if (edge > 6.5F && edge < 8) return {0.8F, 0.7F, 0.55F};
    if (edge < 11) return {0.6F, 0.04F, 0.06F};
    const bool line =
        distance(std::fmod(row, 9.F), 4) < 0.6F || distance(std::fmod(col, 11.F), 5) < 0.6F;
    return line ? Colour{0.5F, 0.5F, 0.55F} : Colour{0.04F, 0.04F, 0.05F};
}

/// Through a lens that blurs it to 2 x 2 pixels, the optical low-pass filter of such sensors.
FluxVideo blurred_cards(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                for (int part = 0; part < 16; ++part) {
                    const Colour light = cards_on_lines(
                        static_cast<float>(slot),
                        static_cast<float>(row) - 0.75F + 0.5F * static_cast<float>(part / 4),
                        static_cast<float>(col) - 0.75F + 0.5F * static_cast<float>(part % 4));
                    for (int plane = 0; plane < 3; ++plane)
                        video.plane(slot, plane)(row, col) +=
                            light[static_cast<std::size_t>(plane)] / 16;
                }
    return video;
}

TEST(MosaicTest, BestHasLessThanHalfTheErrorOfFastOnColouredEdges) {
    const FrameShape shape{30, 34, 3};
    const FluxVideo video = blurred_cards(20, shape);
    const Recorded recorded =
        record_mosaic(video, ColourFilter::kRggb, random_schedule(30, 34, kPaperExposureSlots, 1));
    const double fast = error_of(decode_mosaic(recorded, DecodeMethod::kFast), video);
    const double best = error_of(decode_mosaic(recorded, DecodeMethod::kBest), video);
    expect_quality("beside_fast", gain_db(best, fast), 5.33);
}

/// By how many dB a mosaic is better than three colours of each pixel; `decode` decodes either.
template <typename Decode>
double gain_beside_colours(const FluxVideo& video, const ExposureSchedule& schedule,
                           const Decode& decode) {
    const Recorded recorded = record_mosaic(video, ColourFilter::kGrbg, schedule);
    const FluxVideo x =
        decode(collect_measurements(recorded.header, recorded.packets, whole(video)));
    return gain_db(error_of(x, video), error_of(decode(measure(video, schedule)), video));
}

// With the schedules of their authors, pixel_flutter and single_bump. Plane by plane they would be
// 4 and 6 dB worse.
TEST(MosaicTest, MethodsOfGreyVideoFindTheMeanOfTheColours) {
    const FluxVideo video = blurred_cards(24, {30, 34, 3});
    int stages = 0;
    const StageObserver observer{.finished =
                                     [&](std::string_view, const FluxVideo& x) {
                                         EXPECT_EQ(x.shape(), video.shape());
                                         ++stages;
                                     },
                                 .iterated = {}};
    expect_quality(
        "reddy2011",
        gain_beside_colours(
            video,
            flutter_schedule({.tile_rows = 16, .tile_cols = 16, .code_slots = 8, .open_slots = 4},
                             1),
            [&](const Measurements& m) { return decode_reddy2011(m, {}, observer).value(); }),
        1.43);
    EXPECT_EQ(stages, 10);
    Hitomi2011Options options;
    options.dictionary = cosine_dictionary({.slots = 8, .side_px = 6}, 4);
    constexpr int kThree[] = {3};
    expect_quality("hitomi2011",
                   gain_beside_colours(video, scattered_schedule({16, 16, 8, false}, kThree, 1),
                                       [&](const Measurements& m) {
                                           return decode_hitomi2011(m, options).value();
                                       }),
                   -6.36);
}

TEST(MosaicTest, TilesFitTogetherAndThreadsDoNotShow) {
    const FrameShape shape{601, 603, 3};  // 2^20 sites are a tile at most
    const FluxVideo video = random_video(3, shape, 1);
    const Recorded recorded = record_mosaic(video, ColourFilter::kGbrg,
                                            random_schedule(601, 603, kPaperExposureSlots, 1));
    const FluxVideo x = decode_mosaic(recorded, DecodeMethod::kNaive);
    FluxVideo single = nearest_samples(  // one block
        collect_measurements(recorded.header, recorded.packets, whole(video)));
    for (float& light : single.data()) light = std::max(light, 0.0F);
    EXPECT_TRUE(std::ranges::equal(x.data(), single.data()));
    const ThreadLimit limit(1);
    EXPECT_TRUE(std::ranges::equal(x.data(), decode_mosaic(recorded, DecodeMethod::kNaive).data()));
}

}  // namespace
}  // namespace stipple
