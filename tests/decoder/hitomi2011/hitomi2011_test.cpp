#include "decoder/hitomi2011/hitomi2011.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "readout/schedules/random_codes.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr AtomShape kPatch{.slots = 8, .side_px = 6};

/// The schedule single_bump.
ExposureSchedule single_bump() {
    constexpr int kThree[] = {3};
    return scattered_schedule({16, 16, 8, false}, kThree, 1);
}

/// Without noise; a sample is exact to 1e-4.
SensorParams exact_sensor() {
    SensorParams params;
    params.shot_noise = false;
    params.read_noise_e = 0;
    params.photons_per_unit = 5e5;
    params.full_scale_e = 6.5e6;
    params.full_well_e = 6.5e6;
    params.bit_depth = 16;
    return params;
}

Hitomi2011Options with(PatchDictionary dictionary) {
    Hitomi2011Options options;
    options.dictionary = std::move(dictionary);
    return options;
}

/// Blocks of the size of a patch, each the sum of 1 and two atoms.
FluxVideo scene_of_atoms(const PatchDictionary& d, int blocks) {
    std::mt19937 random(1);
    FluxVideo video(d.shape.slots, {d.shape.side_px, d.shape.side_px * blocks, 1});
    std::ranges::fill(video.data(), 1.0F);
    for (int block = 0; block < blocks; ++block)
        for (int k = 0; k < 2; ++k) {
            const auto atom =
                d.atom(1 + static_cast<int>(random() % static_cast<unsigned>(d.atoms - 1)));
            const float weight = random() % 2 == 0 ? 3 : -2;
            for (std::size_t i = 0; i < atom.size(); ++i) {
                const auto slot = static_cast<int>(i / d.shape.pixels());
                const auto pixel = static_cast<int>(i % d.shape.pixels());
                video.plane(slot, 0)(pixel / 6, block * 6 + pixel % 6) += weight * atom[i];
            }
        }
    return video;
}

TEST(Hitomi2011Test, ASceneOfAtomsIsDecodedExactly) {
    const PatchDictionary d = cosine_dictionary(kPatch, 3);  // 20 atoms, 36 samples
    const FluxVideo video = scene_of_atoms(d, 5);
    const Measurements m = measure(video, single_bump(), exact_sensor());
    Hitomi2011Options options = with(d);
    options.step_px = 6;
    const FluxVideo x = decode_hitomi2011(m, options).value();
    // Samples are rounded to 2e-4 of light / sqrt(12); 20 atoms of 36 samples amplify that little.
    EXPECT_LT(std::sqrt(mean_square(x.data(), video.data())), 1e-3);
    EXPECT_GT(std::sqrt(mean_square(nearest_samples(m).data(), video.data())), 0.05);
}

/// A soft disc over stripes, which moves.
FluxVideo disc(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const float x = static_cast<float>(col - 5) - 0.5F * static_cast<float>(slot);
                    const float y = static_cast<float>(row - shape.rows / 2);
                    const float inside = std::clamp((40 - x * x - y * y) / 40, 0.0F, 1.0F);
                    video.plane(slot, plane)(row, col) =
                        0.2F + 0.1F * static_cast<float>(col % 12) / 12 +
                        inside * (0.6F - 0.1F * static_cast<float>(plane));
                }
    return video;
}

double middle_error(const FluxVideo& x, const FluxVideo& video) {
    double sum = 0;
    for (int slot = 8; slot < 16; ++slot) sum += mean_square(x.frame(slot), video.frame(slot)) / 8;
    return sum;
}

TEST(Hitomi2011Test, TakesAnyScheduleAndColour) {
    const FrameShape shape{14, 21, 3};
    struct Case {
        const char* name;
        ExposureSchedule schedule;
        double measured_db;  ///< better than the nearest samples
    };
    for (const auto& [name, schedule, measured_db] :
         {Case{"single_bump", single_bump(), 3.37},
          Case{"gapped", gapped_schedule(5, 7, 31, 4), -4.54},
          Case{"interleaved", interleaved_schedule(5, 7, 9, 4), 3.12},
          Case{"weighted", weighted_schedule(single_bump(), 2), 2.19},
          Case{"random", random_schedule(14, 21, kPaperExposureSlots, 1), 6.74}}) {
        const FluxVideo video = disc(24, shape);
        const Measurements m = measure(video, schedule);
        const int slots = std::max(8, schedule.longest_span_slots());
        const auto options = with(cosine_dictionary({.slots = slots, .side_px = 6}, 4));
        const double start = middle_error(nearest_samples(m), video);
        const double error = middle_error(*decode_hitomi2011(m, options), video);
        expect_quality(name, gain_db(error, start), measured_db);
    }
}

// The frames of the schedule begin in slot 3 of the block: patches align with them, and all
// samples of a frame are in one patch.
TEST(Hitomi2011Test, PatchesAlignWithTheFramesOfTheSchedule) {
    const FluxVideo video = disc(24 + 5, {14, 21, 1});
    const Recorded recorded = record(video, single_bump());
    VideoWindow window = whole(video);
    window.first_slot = 5;
    window.slots = 24;
    const Hitomi2011Options options = with(cosine_dictionary(kPatch, 4));
    const FluxVideo x = *decode_hitomi2011(
        collect_measurements(recorded.header, recorded.packets, window), options);
    const FluxVideo all = *decode_hitomi2011(
        collect_measurements(recorded.header, recorded.packets, whole(video)), options);
    for (int slot = 3; slot < 19; ++slot)
        EXPECT_TRUE(std::ranges::equal(x.frame(slot), all.frame(slot + 5))) << slot;
}

TEST(Hitomi2011Test, BitsDoNotDependOnThreads) {
    const Measurements m = measure(disc(16, {14, 21, 1}), single_bump());
    const Hitomi2011Options options = with(cosine_dictionary(kPatch, 4));
    const auto decoded = [&](int threads) {
        const ThreadLimit limit(threads);
        return *decode_hitomi2011(m, options);
    };
    EXPECT_TRUE(std::ranges::equal(decoded(1).data(), decoded(3).data()));
}

TEST(Hitomi2011Test, ClipsAndFramesSmallerThanAPatchAreDecoded) {
    const Hitomi2011Options options = with(cosine_dictionary(kPatch, 2));
    for (const FrameShape shape : {FrameShape{1, 20, 1}, FrameShape{3, 2, 1}})
        for (const int slots : {3, 20}) {
            FluxVideo video(slots, shape);
            std::ranges::fill(video.data(), 0.5F);
            const auto schedule = random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
            const FluxVideo x =
                *decode_hitomi2011(measure(video, schedule, exact_sensor()), options);
            EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v > -1 && v < 3; }));
        }
}

TEST(Hitomi2011Test, SaysWhatDictionaryItNeeds) {
    const Measurements m = measure(disc(24, {14, 21, 1}), single_bump());
    expect_parts(message_of<InputError>([&] { static_cast<void>(decode_hitomi2011(m, {})); }),
                 {"decoder.dictionary: ", "stipple dictionary"});
    const auto shorter = with(cosine_dictionary({.slots = 2, .side_px = 4}, 1));
    expect_parts(message_of<InputError>([&] { static_cast<void>(decode_hitomi2011(m, shorter)); }),
                 {"2 slots", "shorter than all exposures", "the period of the schedule"});
}

TEST(Hitomi2011Test, StopsWhereverItIsTold) {
    const Measurements m = measure(disc(40, {14, 21, 1}), single_bump());
    const Hitomi2011Options options = with(cosine_dictionary(kPatch, 2));
    for (const double until : {0.0, 0.5})
        EXPECT_FALSE(decode_hitomi2011(m, options, [&](double done) { return done < until; }));
}

}  // namespace
}  // namespace stipple
