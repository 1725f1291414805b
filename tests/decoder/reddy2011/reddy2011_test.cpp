#include "decoder/reddy2011/reddy2011.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "readout/schedules/random_codes.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

/// Soft stripes and a disc, which moves by `speed` pixels a slot.
FluxVideo disc(int slots, FrameShape shape, float speed) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const float x = static_cast<float>(col) - 10 - speed * static_cast<float>(slot);
                    const float y = static_cast<float>(row - shape.rows / 2);
                    const float wall = 0.2F + 0.1F * static_cast<float>((row / 5 + col / 7) % 3);
                    const float inside = std::clamp(8 - std::sqrt(x * x + y * y), 0.0F, 1.0F);
                    video.plane(slot, plane)(row, col) =
                        wall + inside * (0.8F - 0.2F * static_cast<float>(plane) - wall);
                }
    return video;
}

/// The schedule pixel_flutter.
ExposureSchedule pixel_flutter() {
    return flutter_schedule({.tile_rows = 16, .tile_cols = 16, .code_slots = 8, .open_slots = 4},
                            1);
}

double error_of(const FluxVideo& x, const FluxVideo& video, int begin, int end) {
    double sum = 0;
    for (int slot = begin; slot < end; ++slot)
        sum += mean_square(x.frame(slot), video.frame(slot)) / (end - begin);
    return sum;
}

TEST(Reddy2011Test, EachStageIsBetterAndBitsDoNotDependOnThreads) {
    const FluxVideo video = disc(16, {32, 45, 1}, 0.5F);
    const Measurements m = measure(video, pixel_flutter());
    std::map<std::string, double> stages;
    const StageObserver observer{.finished =
                                     [&](std::string_view stage, const FluxVideo& x) {
                                         stages[std::string(stage)] = error_of(x, video, 0, 16);
                                     },
                                 .iterated = {}};
    const auto decoded = [&](int threads, const StageObserver& told) {
        const ThreadLimit limit(threads);
        return decode_reddy2011(m, {}, told).value();
    };
    const FluxVideo x = decoded(1, observer);
    ASSERT_EQ(stages.size(), 5U);
    expect_quality("round3", gain_db(stages["round3"], stages["start"]), 3.30);
    EXPECT_LT(stages["round1"], stages["without_flow"]);
    EXPECT_LT(stages["round3"], stages["round1"]);
    EXPECT_TRUE(std::ranges::equal(x.data(), decoded(3, {}).data()));
}

// Brightness constancy joins the slots of a scene without motion.
TEST(Reddy2011Test, AStaticSceneIsBetterAlongFlow) {
    const FluxVideo video = disc(16, {24, 24, 1}, 0);
    const Measurements m = measure(video, pixel_flutter());
    const auto error = [&](int rounds) {
        return error_of(*decode_reddy2011(m, {.rounds = rounds}), video, 0, 16);
    };
    EXPECT_GT(gain_db(error(1), error(0)), 1.5);
}

TEST(Reddy2011Test, TakesAnyScheduleAndColour) {
    const FrameShape shape{18, 22, 3};
    struct Case {
        const char* name;
        ExposureSchedule schedule;
        double measured_db;  ///< better than the nearest samples
    };
    for (const auto& [name, schedule, measured_db] :
         {Case{"pixel_flutter", pixel_flutter(), 1.97},
          Case{"gapped", gapped_schedule(5, 7, 31, 4), 2.55},
          Case{"interleaved", interleaved_schedule(5, 7, 9, 4), 2.37},
          Case{"weighted", weighted_schedule(pixel_flutter(), 2), 2.53},
          Case{"random", random_schedule(18, 22, kPaperExposureSlots, 1), 4.69}}) {
        const FluxVideo video = disc(24, shape, 1);
        const Measurements m = measure(video, schedule);
        const double start = error_of(nearest_samples(m), video, 8, 16);
        const Reddy2011Options quick{.first_iterations = 60, .rounds = 2, .iterations = 40};
        const double error = error_of(*decode_reddy2011(m, quick), video, 8, 16);
        expect_quality(name, gain_db(error, start), measured_db);
    }
}

TEST(Reddy2011Test, StopsWhereverItIsTold) {
    const Measurements m = measure(disc(8, {20, 20, 1}, 1), pixel_flutter());
    for (const double until : {0.0, 0.2, 0.5, 0.9}) {
        double reached = 0;
        const auto x = decode_reddy2011(m, {}, {}, [&](double fraction) {
            EXPECT_GE(fraction, reached) << "goes on";
            reached = fraction;
            return fraction < until;
        });
        EXPECT_FALSE(x.has_value());
        EXPECT_LT(reached, 1);
    }
}

}  // namespace
}  // namespace stipple
