// Every schedule of config/schedules through the same chip, stream and decoder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "scenes/scene.h"
#include "tests/pipeline/clip.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 56, .planes = 1};
constexpr int kSlots = 40;
constexpr int kMargin = 8;  ///< slots at both ends: exposures cut off by them are not read

/// A bright disc that moves a pixel a slot over a slanted, chequered wall.
FluxVideo scene(FrameShape shape) {
    FluxVideo video(kSlots, shape);
    for (int slot = 0; slot < kSlots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const int x = col - 8 - slot;
                    const int y = row - 20;
                    const int wall = 4 + plane + col / 8 + 6 * ((row / 10 + col / 10) % 2);
                    video.plane(slot, plane)(row, col) =
                        static_cast<float>(x * x + y * y < 100 ? 40 - 8 * plane : wall) / 64;
                }
    return video;
}

std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(project_path("config/schedules")))
        names.push_back(file.path().stem().string());
    std::ranges::sort(names);
    return names;
}

double mean_square_error(const FluxVideo& x, const FluxVideo& truth) {
    double sum = 0;
    std::size_t count = 0;
    for (int slot = kMargin; slot < kSlots - kMargin; ++slot)
        for (std::size_t i = 0; i < truth.shape().sites(); ++i, ++count) {
            const double error =
                static_cast<double>(x.frame(slot)[i]) - static_cast<double>(truth.frame(slot)[i]);
            sum += error * error;
        }
    return sum / static_cast<double>(count);
}

/// What the best constant leaves.
double variance_of(const FluxVideo& video) {
    FluxVideo mean(kSlots, video.shape());
    double sum = 0;
    for (const float light : video.data()) sum += static_cast<double>(light);
    std::ranges::fill(mean.data(), static_cast<float>(sum / static_cast<double>(video.voxels())));
    return mean_square_error(mean, video);
}

/// A constant frame leaves the variance. `naive` must be below it with light in the right place,
/// `fast` three times below (4.8 dB), whatever the schedule.
void expect_decoded(const std::filesystem::path& file, const FluxVideo& video) {
    const double variance = variance_of(video);
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        const auto decoded = [&](int threads) {
            const ThreadLimit limit(threads);
            return read_recording(file, method);
        };
        const FluxVideo x = decoded(1);
        EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v >= 0 && v < 4; }));
        const double error = mean_square_error(x, video);
        EXPECT_LT(error, variance / (method == DecodeMethod::kFast ? 3 : 1)) << "of " << variance;
        const FluxVideo with_two_threads = decoded(2);
        EXPECT_TRUE(std::ranges::equal(x.data(), with_two_threads.data()));
        testing::Test::RecordProperty(method == DecodeMethod::kFast ? "fast" : "naive",
                                      std::to_string(10 * std::log10(1 / error)));
    }
}

class SchedulesTest : public testing::TestWithParam<std::string> {};

TEST_P(SchedulesTest, EmulatesAndDecodesThroughTheSameCode) {
    const TemporaryFolder folder;
    const FluxVideo video = scene(kShape);
    write_recording(video, GetParam(), folder / "clip.stipple");
    expect_decoded(folder / "clip.stipple", video);
}

// Each pixel sees one of three colours, those of the disc and the wall differ.
TEST_P(SchedulesTest, DecodesAMosaicOfColours) {
    const TemporaryFolder folder;
    const FluxVideo video = scene({kShape.rows, kShape.cols, 3});
    write_mosaic(video, ColourFilter::kGrbg, schedule_of(GetParam(), kShape),
                 folder / "clip.stipple");
    expect_decoded(folder / "clip.stipple", video);
}

// What rests is known where it was sampled, so no prior may be worse than holding that. Light up to
// 2.0, what a sample of one slot can hold; small highlights in it.
TEST_P(SchedulesTest, NothingAtRestIsWorseThanByNaive) {
    const FrameShape shape{.rows = 48, .cols = 64, .planes = 1};
    const Scene still(SceneName::kStill, {.slots = 1, .shape = shape, .time_samples = 1});
    FluxVideo video(kSlots, shape);
    for (int slot = 0; slot < kSlots; ++slot) {
        still.render(0, video.frame(slot));
        for (float& light : video.frame(slot)) light = std::min(light, 2.0F);
    }
    const TemporaryFolder folder;
    write_recording(video, GetParam(), folder / "clip.stipple");
    const auto quality = [&](DecodeMethod method) {
        return quality_of(read_recording(folder / "clip.stipple", method), video);
    };
    const VideoQuality naive = quality(DecodeMethod::kNaive);
    for (const DecodeMethod method : {DecodeMethod::kFast, DecodeMethod::kBest}) {
        const VideoQuality found = quality(method);
        EXPECT_GT(found.psnr_db, naive.psnr_db - 0.3);
        EXPECT_GT(found.psnr_gamma_db, naive.psnr_gamma_db - 0.3);
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SchedulesTest, testing::ValuesIn(names()),
                         [](const auto& file) { return file.param; });

}  // namespace
}  // namespace stipple
