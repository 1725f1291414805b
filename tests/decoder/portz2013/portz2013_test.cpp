#include "decoder/portz2013/portz2013.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "sensor_model/sensor_params.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

/// As published, with a smaller window and fewer iterations.
Portz2013Options quick() {
    Portz2013Options options;
    options.stage1.search.window_px = 4;
    options.stage1.search.window_slots = 2;
    options.stage2.search.window_px = 4;
    options.stage2.admm.iterations = 10;
    return options;
}

/// A bright square that crosses a striped wall.
FluxVideo square(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const bool inside =
                        std::abs(row - shape.rows / 2) < 5 && std::abs(col - 8 - slot / 2) < 5;
                    video.plane(slot, plane)(row, col) =
                        inside ? 0.8F - 0.2F * static_cast<float>(plane)
                               : 0.2F + 0.1F * static_cast<float>((row + col) / 6 % 2);
                }
    return video;
}

/// Mean square error in the middle of a clip: its ends have no samples.
double middle_error(const FluxVideo& x, const FluxVideo& video) {
    double sum = 0;
    const int middle = x.slots() / 2;
    for (int slot = middle - 3; slot < middle + 3; ++slot)
        sum += mean_square(x.frame(slot), video.frame(slot));
    return sum / 6;
}

TEST(Portz2013Test, EachStageIsBetterAndBitsDoNotDependOnThreads) {
    const FluxVideo video = square(16, {20, 24, 1});
    const Measurements m = measure(video, random_schedule(20, 24, kPaperExposureSlots, 1));
    std::vector<std::pair<std::string, double>> stages;
    int iterations = 0;
    const StageObserver observer{
        .finished = [&](std::string_view stage,
                        const FluxVideo& x) { stages.emplace_back(stage, middle_error(x, video)); },
        .iterated = [&](std::string_view, int, double) { ++iterations; }};
    const auto decoded = [&](int threads, const StageObserver& told) {
        const ThreadLimit limit(threads);
        return decode_portz2013(m, quick(), told).value();
    };
    const FluxVideo x = decoded(1, observer);
    ASSERT_EQ(stages.size(), 3U);
    EXPECT_EQ(stages[0].first, "start");
    EXPECT_EQ(stages[1].first, "stage1");
    EXPECT_EQ(stages[2].first, "stage2");
    expect_quality("stage1", gain_db(stages[1].second, stages[0].second), 3.39);
    expect_quality("stage2", gain_db(stages[2].second, stages[0].second), 4.87);
    EXPECT_EQ(iterations, 10 + 10);
    EXPECT_TRUE(std::ranges::equal(x.data(), decoded(2, {}).data()));
}

TEST(Portz2013Test, RhoIsInTheUnitOfEquation1) {
    const SensorParams paper;
    EXPECT_FLOAT_EQ(Portz2013Options().values_per_flux,
                    static_cast<float>(paper.photons_per_unit / paper.full_scale_e));
}

TEST(Portz2013Test, SaturatedRegionsAreNotDraggedDown) {
    // At 0.9 the samples of 4 and of 8 slots are full at 2.0: as equalities they say 0.5 and 0.25.
    FluxVideo video(16, {20, 20, 1});
    std::ranges::fill(video.data(), 0.9F);
    const Measurements m = measure(video, random_schedule(20, 20, kPaperExposureSlots, 1));
    const FluxVideo x = decode_portz2013(m, quick()).value();
    double middle = 0;
    for (int slot = 4; slot < 12; ++slot)
        for (const float light : x.frame(slot)) middle += static_cast<double>(light) / (8 * 400);
    EXPECT_NEAR(middle, 0.9, 0.03);
}

TEST(Portz2013Test, TakesAnyScheduleAndColour) {
    const FrameShape shape{9, 14, 3};
    struct Case {
        const char* name;
        ExposureSchedule schedule;
        double measured_db;  ///< better than the nearest samples
    };
    for (const auto& [name, schedule, measured_db] :
         {Case{"gapped", gapped_schedule(5, 7, 31, 4), 0.20},
          Case{"interleaved", interleaved_schedule(5, 7, 9, 4), 5.78},
          Case{"random", random_schedule(9, 14, kPaperExposureSlots, 1), 9.82}}) {
        const FluxVideo video = square(schedule.period_slots() + 6, shape);
        const Measurements m = measure(video, schedule);
        const FluxVideo x = decode_portz2013(m, quick()).value();
        const double start = middle_error(nearest_samples(m), video);
        EXPECT_LT(middle_error(x, video), start) << name;
        expect_quality(name, gain_db(middle_error(x, video), start), measured_db);
    }
}

TEST(Portz2013Test, TinyBlocksAndNoSamplesAreDecoded) {
    for (const FrameShape shape : {FrameShape{1, 20, 1}, FrameShape{3, 2, 1}}) {
        const FluxVideo video = square(20, shape);
        const auto schedule = random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
        const FluxVideo x = decode_portz2013(measure(video, schedule), quick()).value();
        EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v > -1 && v < 3; }));
    }
    FluxVideo video(1, {8, 8, 1});
    constexpr int kEight[] = {8};
    const Measurements m = measure(video, random_schedule(8, 8, kEight, 1));
    const FluxVideo x = decode_portz2013(m, quick()).value();
    EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v == 0; }));
}

TEST(Portz2013Test, StopsWhereverItIsTold) {
    const FluxVideo video = square(8, {20, 20, 1});
    const Measurements m = measure(video, random_schedule(20, 20, kPaperExposureSlots, 1));
    for (const double until : {0.0, 0.1, 0.25, 0.4, 0.52, 0.8}) {
        double reached = 0;
        const auto x = decode_portz2013(m, quick(), {}, [&](double fraction) {
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
