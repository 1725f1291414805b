// Every schedule of config/schedules through the same chip, stream and decoder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "tests/core/temporary_folder.h"
#include "tests/pipeline/clip.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 56, .planes = 1};
constexpr int kSlots = 40;
constexpr int kMargin = 8;  ///< slots at both ends: exposures cut off by them are not read

/// A bright disc that moves a pixel a slot over a slanted, chequered wall.
FluxVideo scene() {
    FluxVideo video(kSlots, kShape);
    for (int slot = 0; slot < kSlots; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col) {
                const int x = col - 8 - slot;
                const int y = row - 20;
                const int wall = 4 + col / 8 + 6 * ((row / 10 + col / 10) % 2);
                video.plane(slot, 0)(row, col) =
                    static_cast<float>(x * x + y * y < 100 ? 40 : wall) / 64;
            }
    return video;
}

std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(
             std::filesystem::path(STIPPLE_SOURCE_DIR) / "config/schedules"))
        names.push_back(file.path().stem().string());
    std::ranges::sort(names);
    return names;
}

double mean_square_error(const FluxVideo& x, const FluxVideo& truth) {
    double sum = 0;
    std::size_t count = 0;
    for (int slot = kMargin; slot < kSlots - kMargin; ++slot)
        for (std::size_t i = 0; i < kShape.sites(); ++i, ++count) {
            const double error =
                static_cast<double>(x.frame(slot)[i]) - static_cast<double>(truth.frame(slot)[i]);
            sum += error * error;
        }
    return sum / static_cast<double>(count);
}

/// What the best constant leaves.
double variance_of(const FluxVideo& video) {
    FluxVideo mean(kSlots, kShape);
    double sum = 0;
    for (const float light : video.data()) sum += static_cast<double>(light);
    std::ranges::fill(mean.data(), static_cast<float>(sum / static_cast<double>(video.voxels())));
    return mean_square_error(mean, video);
}

class SchedulesTest : public testing::TestWithParam<std::string> {};

// A constant frame leaves the variance. `naive` must be below it with light in the right place,
// `fast` three times below (4.8 dB), whatever the schedule.
TEST_P(SchedulesTest, EmulatesAndDecodesThroughTheSameCode) {
    const TemporaryFolder folder;
    const FluxVideo video = scene();
    write_recording(video, GetParam(), folder / "clip.stipple");
    const double variance = variance_of(video);
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        const auto decoded = [&](int threads) {
            const ThreadLimit limit(threads);
            return read_recording(folder / "clip.stipple", method);
        };
        const FluxVideo x = decoded(1);
        EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v >= 0 && v < 4; }));
        const double error = mean_square_error(x, video);
        EXPECT_LT(error, variance / (method == DecodeMethod::kFast ? 3 : 1)) << "of " << variance;
        const FluxVideo with_two_threads = decoded(2);
        EXPECT_TRUE(std::ranges::equal(x.data(), with_two_threads.data()));
        RecordProperty(method == DecodeMethod::kFast ? "fast" : "naive",
                       std::to_string(10 * std::log10(1 / error)));
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SchedulesTest, testing::ValuesIn(names()),
                         [](const auto& file) { return file.param; });

}  // namespace
}  // namespace stipple
