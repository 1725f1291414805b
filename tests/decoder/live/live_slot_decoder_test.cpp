#include "decoder/live/live_slot_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "decoder/live/live_decoder.h"
#include "readout/schedules/random_codes.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr int kSlots = 36;

ExposureSchedule paper_schedule(FrameShape shape) {
    return random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
}

/// Slot `slot` of a recording, from the samples of its window.
LiveSlotDecoder::Frame slot_of(const Recorded& recorded, FrameShape shape, int slot,
                               LiveSlotDecoder& decoder) {
    const LiveWindow live = live_window(slot, kSlots);
    const std::span packets(recorded.packets);
    const VideoWindow window{live.begin, live.slots(), 0, 0, shape};
    return decoder.decode(
        recorded.header,
        packets.subspan(static_cast<std::size_t>(live.begin),
                        static_cast<std::size_t>(live.slots())),
        window, {0, live.core_begin - live.begin, live.core_end - live.begin, live.slots()},
        slot - live.begin);
}

void expect_slots_of_decode_live(const Recorded& recorded, const FluxVideo& video) {
    const FrameShape shape = video.shape();
    const auto all =
        decode_live(collect_measurements(recorded.header, recorded.packets, whole(video)));
    LiveSlotDecoder decoder;
    for (const int slot : {0, 1, 7, 8, 19, 24, kSlots - 1}) {
        const auto frame = slot_of(recorded, shape, slot, decoder);
        std::vector<float> expected(all->frame(slot).begin(), all->frame(slot).end());
        for (float& light : expected) light = std::max(light, 0.0F);
        EXPECT_TRUE(std::ranges::equal(frame.light.data(), expected)) << slot;
    }
}

// The rows are several bands, and the last one is cut.
TEST(LiveSlotDecoderTest, HasTheBitsOfDecodeLive) {
    for (const FrameShape shape : {FrameShape{.rows = 83, .cols = 45, .planes = 1},
                                   FrameShape{.rows = 70, .cols = 20, .planes = 3},
                                   FrameShape{.rows = 3, .cols = 2, .planes = 1}}) {
        const FluxVideo video = random_video(kSlots, shape, 3);
        expect_slots_of_decode_live(record(video, paper_schedule(shape)), video);
    }
}

TEST(LiveSlotDecoderTest, HasTheBitsOfDecodeLiveOfAMosaicAndOfTwoBuckets) {
    const FluxVideo video = random_video(kSlots, {.rows = 71, .cols = 30, .planes = 3}, 3);
    expect_slots_of_decode_live(
        record_mosaic(video, ColourFilter::kRggb, paper_schedule({71, 30, 1})), video);
    const ExposureSchedule two_buckets(1, 1, 8, {0, 2}, {{0, 0b1010101}, {1, 0b1010101}});
    expect_slots_of_decode_live(record(video, two_buckets), video);
}

TEST(LiveSlotDecoderTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FrameShape shape{.rows = 150, .cols = 31, .planes = 1};
    const Recorded recorded = record(random_video(kSlots, shape, 5), paper_schedule(shape));
    LiveSlotDecoder decoder;
    const auto first = slot_of(recorded, shape, 17, decoder);
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        const auto frame = slot_of(recorded, shape, 17, decoder);
        EXPECT_TRUE(std::ranges::equal(frame.light.data(), first.light.data())) << threads;
        EXPECT_EQ(frame.known, first.known);
    }
}

TEST(SlotsWithASampleTest, ReachFromOneBeginToTheEndOfTheNextExposure) {
    EXPECT_EQ(slots_with_a_sample({1, 1, 1, {0, 1}, {{.first_slot = 0, .open_slots = 1}}}), 1);
    // Exposures of 1, 2, 4 and 8 slots: the 8 after the 4, of which the first slot has passed.
    EXPECT_EQ(slots_with_a_sample(paper_schedule({.rows = 30, .cols = 30, .planes = 1})), 11);
    // One of three slots in ten: from slot 1 to slot 12.
    EXPECT_EQ(slots_with_a_sample({1, 1, 10, {0, 1}, {{.first_slot = 0, .open_slots = 0b101}}}),
              12);
}

}  // namespace
}  // namespace stipple
