#include "decoder/decode_cost.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "stream/stream_writer.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(DecodeCostTest, WhatIsComputedForTheFirstFramesIsWhatProgressReaches) {
    constexpr int kSlots = 70;  // blocks of 48 and 22 slots
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    const Recorded recorded =
        record(flat_video(kSlots, {8, 8, 1}, 0.2F), random_schedule(8, 8, kPaperExposureSlots, 1));
    StreamWriter writer(file, recorded.header);
    for (const SamplePacket& packet : recorded.packets) writer.write(packet);
    writer.finish();
    for (const int frames : {1, 47, 48, 49, 70}) {
        StreamReader reader(file);
        double reached = 0;
        decode(
            reader, DecodeMethod::kNaive,
            [&](std::int64_t slot, std::span<const float>) { return slot + 1 < frames; },
            [&](double slots) {
                reached = slots;
                return true;
            });
        EXPECT_EQ(static_cast<double>(computed_slots(frames, kSlots)), reached) << frames;
    }
    EXPECT_EQ(computed_slots(0, kSlots), 0);
}

TEST(DecodeCostTest, TimeIsThatOfTheVoxelsSharedByTheThreads) {
    const TemporaryFolder folder;
    const Recorded recorded =
        record(flat_video(30, {8, 16, 1}, 0.2F), random_schedule(8, 16, kPaperExposureSlots, 1));
    StreamWriter writer(folder / "clip.stipple", recorded.header);
    writer.finish();
    StreamReader reader(folder / "clip.stipple");
    const RigStream alone{reader};
    const ThreadLimit threads(2);
    const DecodeCost cost = expected_cost({&alone, 1}, DecodeMethod::kBest, 30);
    EXPECT_DOUBLE_EQ(cost.seconds, 1e-6 * named(DecodeMethod::kBest).voxel_us * 30 * 128 /
                                       thread_count());  // 1 under the sanitizers
    EXPECT_EQ(cost.bytes, (named(DecodeMethod::kBest).voxel_bytes + 4) * 30 * 128);
}

}  // namespace
}  // namespace stipple
