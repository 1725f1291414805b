#include "decoder/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/block_partition.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "stream/stream_writer.h"
#include "tests/decoder/recordings.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// A bright disc that crosses a lit wall.
FluxVideo disc(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const double distance = std::hypot(row - shape.rows / 2, col - 10 - slot / 2);
                    video.plane(slot, plane)(row, col) = static_cast<float>(
                        distance < 8 ? 0.9 - 0.2 * plane : 0.2 + 0.1 * ((row / 5 + col / 5) % 2));
                }
    return video;
}

class ReconstructTest : public testing::Test {
  protected:
    std::filesystem::path write(const FluxVideo& video, const ExposureSchedule& schedule) {
        const Recorded recorded = record(video, schedule);
        const auto file = folder_ / "clip.stipple";
        StreamWriter writer(file, recorded.header);
        for (const SamplePacket& packet : recorded.packets) writer.write(packet);
        writer.finish();
        return file;
    }
    static std::vector<float> decode_all(const std::filesystem::path& file, DecodeMethod method,
                                         FrameShape shape) {
        StreamReader reader(file);
        std::vector<float> x;
        std::int64_t next = 0;
        const DecodeReport report =
            decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
                EXPECT_EQ(slot, next++);
                EXPECT_EQ(frame.size(), shape.sites());
                x.insert(x.end(), frame.begin(), frame.end());
                return true;
            });
        EXPECT_EQ(report.slots, next);
        EXPECT_EQ(report.voxels, x.size());
        return x;
    }
    TemporaryFolder folder_;
};

TEST(DecodeMethodTest, KnowsItsNames) {
    EXPECT_EQ(decode_method_from_name("naive"), DecodeMethod::kNaive);
    EXPECT_EQ(decode_method_from_name("fast"), DecodeMethod::kFast);
    expect_parts(
        message_of<InputError>([] { return decode_method_from_name("slow"); }),
        {"slow", "naive, live, fast, best, learned_fast, learned, plug_and_play, portz2013"});
}

TEST_F(ReconstructTest, DeliversEverySlotOfALongClipWithoutSeams) {
    const FrameShape shape{32, 90, 1};
    const FluxVideo video = disc(150, shape);  // blocks of 48, 48 and 54 slots
    const auto file = write(video, random_schedule(32, 90, kPaperExposureSlots, 1));
    const auto x = decode_all(file, DecodeMethod::kFast, shape);
    ASSERT_EQ(x.size(), video.voxels());
    const auto error = [&](int first, int slots) {
        const auto begin = static_cast<std::size_t>(first) * shape.sites();
        const auto count = static_cast<std::size_t>(slots) * shape.sites();
        return mean_square(std::span(x).subspan(begin, count), video.data().subspan(begin, count));
    };
    // The slots at a seam, beside those in the middle of blocks.
    expect_quality("first_seam", gain_db(error(46, 4), error(20, 8)), -1.09);
    expect_quality("second_seam", gain_db(error(94, 4), error(68, 8)), -0.04);
    EXPECT_LT(error(8, 130),
              0.25 * mean_square(decode_all(file, DecodeMethod::kNaive, shape), video.data()));
}

// Exposures of 24 slots that begin in slot 30 of 48 lie across the end of each block; without them
// the slots around it would be known from other pixels alone.
TEST_F(ReconstructTest, KeepsLongExposuresThatLieAcrossBlocks) {
    const FrameShape shape{16, 24, 1};
    FluxVideo video(110, shape);
    std::ranges::fill(video.data(), 0.05F);
    const ExposureSchedule schedule(1, 1, 48, {0, 1}, {{30, ~std::uint64_t{0} >> 40U}});
    const auto x = decode_all(write(video, schedule), DecodeMethod::kNaive, shape);
    for (int slot = 40; slot < 54; ++slot)  // a sample is 1.2 +- 0.04, a slot 0.05 +- 0.0015
        EXPECT_NEAR(x[static_cast<std::size_t>(slot) * shape.sites()], 0.05, 0.01) << slot;
}

TEST_F(ReconstructTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FrameShape shape{24, 40, 3};
    const auto file = write(disc(70, shape), random_schedule(24, 40, kPaperExposureSlots, 1));
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        const auto decoded = [&](int threads) {
            const ThreadLimit limit(threads);
            return decode_all(file, method, shape);
        };
        EXPECT_EQ(decoded(1), decoded(2));
    }
}

TEST_F(ReconstructTest, AnyBlockCanBeTheFirst) {
    const FrameShape shape{24, 30, 1};
    const std::int64_t slots = 150;
    const auto file = write(disc(slots, shape), random_schedule(24, 30, kPaperExposureSlots, 1));
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        const auto all = decode_all(file, method, shape);
        for (std::int64_t block = 0; block < block_count(slots); ++block) {
            StreamReader reader(file);
            std::int64_t next = block_begin(block);
            const DecodeReport report = decode(
                reader, {.method = method, .first_slot = next},
                [&](std::int64_t slot, std::span<const float> frame) {
                    EXPECT_EQ(slot, next++);
                    const auto whole = std::span(all).subspan(index(slot) * shape.sites());
                    EXPECT_TRUE(std::ranges::equal(frame, whole.first(shape.sites()))) << slot;
                    return true;
                });
            EXPECT_EQ(next, slots);
            EXPECT_EQ(report.slots, slots - block_begin(block));
        }
    }
}

TEST_F(ReconstructTest, CutsLargeFramesIntoTilesThatFitTogether) {
    const FrameShape shape{1030, 1040, 1};
    FluxVideo video(3, shape);
    for (int slot = 0; slot < 3; ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                video.plane(slot, 0)(row, col) =
                    static_cast<float>(row * 7 + col * 3 + slot) / 1e4F;
    const ExposureSchedule schedule = random_schedule(1030, 1040, kPaperExposureSlots, 1);
    const auto x = decode_all(write(video, schedule), DecodeMethod::kNaive, shape);
    const FluxVideo single = [&] {  // one block
        const Recorded recorded = record(video, schedule);
        return nearest_samples(
            collect_measurements(recorded.header, recorded.packets, whole(video)));
    }();
    EXPECT_TRUE(std::ranges::equal(x, single.data()));
}

TEST_F(ReconstructTest, DecodesFramesTooSmallForMotion) {
    for (const FrameShape shape :
         {FrameShape{1, 1, 1}, FrameShape{1, 40, 3}, FrameShape{15, 3, 1}}) {
        const FluxVideo video = random_video(40, shape, 1);
        std::filesystem::remove(folder_ / "clip.stipple");
        const auto x = decode_all(
            write(video, random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1)),
            DecodeMethod::kFast, shape);
        EXPECT_EQ(x.size(), video.voxels());
        EXPECT_TRUE(std::ranges::all_of(x, [](float v) { return v >= 0 && v < 3; }));
    }
}

TEST_F(ReconstructTest, StopsWhenTheSinkHasEnough) {
    const FrameShape shape{16, 16, 1};
    StreamReader reader(write(disc(100, shape), random_schedule(16, 16, kPaperExposureSlots, 1)));
    const DecodeReport report =
        decode(reader, DecodeMethod::kNaive,
               [](std::int64_t slot, std::span<const float>) { return slot < 60; });
    EXPECT_EQ(report.slots, 61);
}

TEST_F(ReconstructTest, ReportsProgressAndStopsInTheMidstOfABlock) {
    const FrameShape shape{16, 16, 1};
    const auto file = write(disc(100, shape), random_schedule(16, 16, kPaperExposureSlots, 1));
    double last = 0;
    const auto run = [&](double stop_at) {
        StreamReader reader(file);
        last = 0;
        return decode(
            reader, DecodeMethod::kFast, [](std::int64_t, std::span<const float>) { return true; },
            [&](double slots) {
                EXPECT_GE(slots, last);
                last = slots;
                return slots < stop_at;
            });
    };
    EXPECT_EQ(run(1e9).slots, 100);
    EXPECT_DOUBLE_EQ(last, 100);
    EXPECT_EQ(run(60).slots, 48);  // blocks of 48 and 52 slots
    EXPECT_NEAR(last, 60, 5);      // as finely as motion is found
}

TEST_F(ReconstructTest, DeliversNothingOfAnEmptyRecording) {
    const FrameShape shape{16, 16, 1};
    EXPECT_TRUE(
        decode_all(write(FluxVideo(0, shape), random_schedule(16, 16, kPaperExposureSlots, 1)),
                   DecodeMethod::kFast, shape)
            .empty());
}

TEST_F(ReconstructTest, FillsWhatALostPacketLeavesUnknown) {
    const FrameShape shape{32, 90, 1};
    const FluxVideo video = disc(60, shape);
    const Recorded recorded = record(video, random_schedule(32, 90, kPaperExposureSlots, 1));
    StreamBytes stream = bytes_of(recorded.header, recorded.packets);
    stream.bytes.erase(stream.begins[30], stream.begins[32] - stream.begins[30]);
    write_text(folder_ / "lossy.stipple", stream.bytes);
    const auto x = decode_all(folder_ / "lossy.stipple", DecodeMethod::kFast, shape);
    ASSERT_EQ(x.size(), video.voxels());
    const auto at = 30 * shape.sites();
    const auto lost = std::span(x).subspan(at, 2 * shape.sites());
    // Above the naive estimate, which has nothing to go by but other slots either.
    const auto naive = decode_all(folder_ / "lossy.stipple", DecodeMethod::kNaive, shape);
    const auto truth = video.data().subspan(at, lost.size());
    expect_quality("lost_slots",
                   gain_db(mean_square(lost, truth),
                           mean_square(std::span(naive).subspan(at, lost.size()), truth)),
                   7.55);
}

/// A stream of one slot, then one packet of `slot`.
std::string with_gap(const StreamHeader& header, std::uint64_t slot) {
    StreamBytes stream = bytes_of(header, {{0, 0, 2, 0, {1, 2, 3, 4}}});
    PacketHeader far;
    far.slot = slot;
    far.rows = 2;
    far.samples = 4;
    return stream.bytes.substr(0, stream.begins[1]) + framed(far, "1234", stream.seed());
}

TEST_F(ReconstructTest, GoesOnAfterALongGapAtOnce) {
    const FrameShape shape{2, 2, 1};
    const StreamHeader header = record(disc(1, shape), {1, 1, 1, {0, 1}, {{0, 1}}}).header;
    write_text(folder_ / "gap.stipple", with_gap(header, 90000));
    StreamReader reader(folder_ / "gap.stipple");
    std::vector<float> x;
    decode(reader, DecodeOptions{.method = DecodeMethod::kFast, .fill_gaps = true},
           [&](std::int64_t, std::span<const float> frame) {
               x.insert(x.end(), frame.begin(), frame.end());
               return true;
           });
    ASSERT_EQ(x.size(), 90001U * shape.sites());
    EXPECT_EQ(x[50000 * shape.sites()], 0);
    EXPECT_GT(x.back(), 0.2F);  // '4' is 52 DN, 0.41
}

// 8 slots of 4 million pixels that the chip dropped: at 58 bytes a voxel more than 256 MiB.
TEST_F(ReconstructTest, ASmallFileTakesLittleMemory) {
    constexpr int kSide = 2000;
    StreamHeader header = record(disc(1, {2, 2, 1}), {1, 1, 1, {0, 1}, {{0, 1}}}).header;
    header.shape = {kSide, kSide, 1};
    std::vector<SamplePacket> packets;
    for (std::int64_t slot = 0; slot < 8; ++slot)
        packets.push_back({slot, 0, kSide, SamplePacket::kDropped, {}});
    const std::string bytes = bytes_of(header, packets).bytes;
    write_text(folder_ / "small.stipple", bytes);
    StreamReader reader(folder_ / "small.stipple");
    EXPECT_EQ(reader.input_bytes(), bytes.size());
    reader.use_name("a small file");
    expect_parts(message_of<InputError>([&] {
                     return decode(reader, DecodeMethod::kFast,
                                   [](std::int64_t, std::span<const float>) { return true; });
                 }),
                 {"a small file: needs", "a file of less than 1 MB may take"});
}

TEST_F(ReconstructTest, RefusesAGapThatNoRecordingHas) {
    const FrameShape shape{2, 2, 1};
    const StreamHeader header = record(disc(1, shape), {1, 1, 1, {0, 1}, {{0, 1}}}).header;
    write_text(folder_ / "gap.stipple", with_gap(header, std::uint64_t{1} << 40U));
    StreamReader reader(folder_ / "gap.stipple");
    expect_parts(message_of<InputError>([&] {
                     return decode(reader, DecodeMethod::kNaive,
                                   [](std::int64_t, std::span<const float>) { return true; });
                 }),
                 {"slots 1 to 1099511627775 are missing", "fill_gaps = true"});
}

}  // namespace
}  // namespace stipple
