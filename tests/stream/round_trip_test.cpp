#include <gtest/gtest.h>

#include "tests/stream/stream_files.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kNone = 0;

/// Writes and reads back, strictly; the report agrees with what was written.
void expect_round_trip(const StreamHeader& header, const std::vector<SamplePacket>& packets,
                       std::int64_t slots) {
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    write_stream(file, header, packets);
    StreamReader reader(file, ReadPolicy::kStrict);
    EXPECT_EQ(reader.header(), header);
    EXPECT_EQ(reader.slots(), slots);
    EXPECT_EQ(read_packets(reader), packets);
    std::uint64_t samples = 0;
    for (const SamplePacket& packet : packets) samples += packet.dn.size();
    const StreamReport& report = reader.report();
    EXPECT_EQ(report.packets, packets.size());
    EXPECT_EQ(report.samples, samples);
    EXPECT_EQ(report.payload_bits,
              samples * static_cast<std::uint64_t>(header.calibration.bit_depth));
    EXPECT_EQ(report.slots, slots);
    EXPECT_EQ(report.missing_slots, 0);
    EXPECT_EQ(report.tail_bytes, kNone);
    EXPECT_TRUE(report.damage.empty());
}

TEST(RoundTripTest, MonoComesBackAtEachBitDepth) {
    for (int bit_depth = 1; bit_depth <= 16; ++bit_depth) {
        const StreamHeader header = varied_header({4, 8, 1}, bit_depth);
        expect_round_trip(header, random_packets(header, 12, 4), 12);
    }
}

TEST(RoundTripTest, StackedColourComesBack) {
    const StreamHeader header = varied_header({5, 7, 3}, 12);
    expect_round_trip(header, random_packets(header, 7, 5), 7);
}

TEST(RoundTripTest, BandsOfRowsComeBack) {
    const StreamHeader header = varied_header({7, 4, 1}, 10);
    expect_round_trip(header, random_packets(header, 6, 3), 6);
}

TEST(RoundTripTest, ARandomScheduleIsStoredByItsSeed) {
    const StreamHeader header = random_header({9, 11, 1}, 0x123456789ABCDEFU);
    expect_round_trip(header, random_packets(header, 40, 9), 40);
}

TEST(RoundTripTest, SlotsFarBeyondTheFirstPeriodComeBack) {
    const StreamHeader header = varied_header({2, 3, 1}, 8);
    expect_round_trip(header, random_packets(header, 200, 2), 200);
}

TEST(RoundTripTest, AStreamWithoutSlotsComesBack) {
    expect_round_trip(varied_header(), {}, 0);
}

TEST(RoundTripTest, FlagsOfOverrunAndDropComeBack) {
    const StreamHeader header = varied_header();
    std::vector<SamplePacket> packets = random_packets(header, 4, 2);
    packets[1].flags = SamplePacket::kOverrun;
    packets[2].flags = SamplePacket::kDropped;
    packets[2].dn.clear();
    packets[5].flags = SamplePacket::kDropped | SamplePacket::kOverrun;
    packets[5].dn.clear();
    expect_round_trip(header, packets, 4);
}

}  // namespace
}  // namespace stipple
