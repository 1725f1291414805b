// Every schedule of config/schedules through the same chip, stream and decoder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "study/scenes/scene.h"
#include "tests/pipeline/clip.h"
#include "tests/support/expect_quality.h"
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

/// PSNR of linear light in dB that was measured with a schedule.
struct ScheduleFigures {
    struct {
        double naive;
        double fast;
    } mono, mosaic;
    struct {
        double fast;
        double best;
    } at_rest;
};

const std::map<std::string, ScheduleFigures> kFigures = {
    // naive, fast; of a mosaic naive, fast; at rest fast, best
    {"alternating", {{25.26, 25.55}, {27.62, 28.41}, {38.76, 40.19}}},
    {"coded_rolling_shutter_exposure", {{25.24, 33.28}, {27.97, 31.98}, {23.91, 24.83}}},
    {"coded_rolling_shutter_staggered", {{23.83, 30.46}, {26.90, 30.87}, {15.14, 15.41}}},
    {"dol", {{24.03, 25.97}, {26.41, 26.11}, {37.01, 39.50}}},
    {"flexible_voxels", {{18.85, 27.29}, {21.66, 26.02}, {34.39, 37.32}}},
    {"full1x", {{25.84, 36.96}, {28.07, 34.57}, {39.36, 42.53}}},
    {"full4x", {{23.83, 25.42}, {26.91, 28.52}, {15.14, 15.36}}},
    {"global_flutter", {{19.32, 23.92}, {22.81, 26.73}, {15.13, 15.41}}},
    {"hardware_tiled", {{24.19, 34.46}, {26.79, 32.68}, {37.52, 41.39}}},
    {"multi_phase_2x2", {{21.28, 32.44}, {23.64, 29.22}, {21.00, 21.50}}},
    {"nd_mosaic", {{23.83, 25.42}, {26.91, 28.52}, {15.14, 15.36}}},
    {"pixel_flutter", {{19.64, 25.78}, {23.15, 27.60}, {15.13, 15.41}}},
    {"random", {{23.18, 33.82}, {25.90, 32.18}, {36.68, 41.94}}},
    {"random_subset", {{23.67, 34.83}, {26.13, 32.95}, {37.85, 41.76}}},
    {"rolling", {{23.83, 25.99}, {26.91, 28.83}, {15.13, 15.41}}},
    {"single_bump", {{23.36, 31.61}, {25.99, 30.71}, {17.80, 18.21}}},
    {"spatially_varying_exposure", {{19.98, 26.53}, {23.05, 26.00}, {19.35, 19.97}}},
    {"tiled", {{23.38, 33.61}, {26.16, 32.26}, {36.39, 41.81}}},
    {"two_bucket", {{22.39, 32.20}, {25.26, 31.90}, {20.50, 21.32}}}};

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
/// `fast` three times below (4.8 dB), whatever the schedule, and both as good as measured.
void expect_decoded(const std::filesystem::path& file, const FluxVideo& video,
                    const std::map<DecodeMethod, double>& measured_db) {
    const double variance = variance_of(video);
    for (const auto& [method, figure_db] : measured_db) {
        const auto decoded = [&](int threads) {
            const ThreadLimit limit(threads);
            return read_recording(file, method);
        };
        const FluxVideo x = decoded(1);
        EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v >= 0 && v < 4; }));
        const double error = mean_square_error(x, video);
        const bool fast = method == DecodeMethod::kFast;
        EXPECT_LT(error, variance / (fast ? 3 : 1)) << "of " << variance;
        expect_quality(fast ? "fast" : "naive", gain_db(error, 1), figure_db);
        const FluxVideo with_two_threads = decoded(2);
        EXPECT_TRUE(std::ranges::equal(x.data(), with_two_threads.data()));
    }
}

class SchedulesTest : public testing::TestWithParam<std::string> {};

TEST_P(SchedulesTest, EmulatesAndDecodesThroughTheSameCode) {
    const TemporaryFolder folder;
    const FluxVideo video = scene(kShape);
    write_recording(video, GetParam(), folder / "clip.stipple");
    const auto& [naive_db, fast_db] = kFigures.at(GetParam()).mono;
    expect_decoded(folder / "clip.stipple", video,
                   {{DecodeMethod::kNaive, naive_db}, {DecodeMethod::kFast, fast_db}});
}

// Each pixel sees one of three colours, those of the disc and the wall differ.
TEST_P(SchedulesTest, DecodesAMosaicOfColours) {
    const TemporaryFolder folder;
    const FluxVideo video = scene({kShape.rows, kShape.cols, 3});
    write_mosaic(video, ColourFilter::kGrbg, schedule_of(GetParam(), kShape),
                 folder / "clip.stipple");
    const auto& [naive_db, fast_db] = kFigures.at(GetParam()).mosaic;
    expect_decoded(folder / "clip.stipple", video,
                   {{DecodeMethod::kNaive, naive_db}, {DecodeMethod::kFast, fast_db}});
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
    const VideoQuality fast = quality(DecodeMethod::kFast);
    const VideoQuality best = quality(DecodeMethod::kBest);
    for (const VideoQuality& found : {fast, best}) {
        EXPECT_GT(found.psnr_db, naive.psnr_db - 0.3);
        EXPECT_GT(found.psnr_gamma_db, naive.psnr_gamma_db - 0.3);
    }
    expect_quality("fast", fast.psnr_db, kFigures.at(GetParam()).at_rest.fast);
    expect_quality("best", best.psnr_db, kFigures.at(GetParam()).at_rest.best);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SchedulesTest, testing::ValuesIn(names()),
                         [](const auto& file) { return file.param; });

}  // namespace
}  // namespace stipple
