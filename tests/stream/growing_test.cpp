#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

TEST(GrowingTest, APacketCanBeReadAsSoonAsItIsWritten) {
    const StreamHeader header = varied_header();
    const TemporaryFolder folder;
    StreamWriter writer(folder / "clip.stipple", header);
    StreamReader reader(folder / "clip.stipple");
    SamplePacket packet;
    EXPECT_FALSE(reader.next(packet));
    for (const SamplePacket& written : random_packets(header, 6, 2)) {
        writer.write(written);
        EXPECT_TRUE(reader.next(packet));
        EXPECT_EQ(packet, written);
        EXPECT_FALSE(reader.next(packet));
    }
    writer.finish();
    EXPECT_FALSE(reader.next(packet));
    EXPECT_EQ(reader.slots(), 6);
    EXPECT_EQ(reader.report().slots, 6);
    EXPECT_EQ(causes(reader.report()), "");
}

/// Lets a file grow byte by byte behind its reader.
Reading read_growing(const StreamBytes& stream) {
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    write_text(file, stream.bytes.substr(0, stream.begins.front()));
    StreamReader reader(file);
    std::ofstream end(file, std::ios::binary | std::ios::app);
    Reading reading;
    SamplePacket packet;
    for (std::size_t at = stream.begins.front(); at < stream.bytes.size(); ++at) {
        end << stream.bytes[at] << std::flush;
        while (reader.next(packet)) reading.packets.push_back(packet);
    }
    reading.report = reader.report();
    return reading;
}

TEST(GrowingTest, AnIncompletePacketIsNoDamage) {
    const StreamHeader header = varied_header();
    const auto packets = random_packets(header, 5, 2);
    const Reading reading = read_growing(bytes_of(header, packets));
    EXPECT_EQ(reading.packets, packets);
    EXPECT_EQ(causes(reading.report), "");
    EXPECT_EQ(reading.report.tail_bytes, 0U);
}

TEST(GrowingTest, DamageCostsTheSameAsInAFinishedFile) {
    const StreamHeader header = varied_header();
    const TemporaryFolder folder;
    const StreamBytes stream = bytes_of(header, random_packets(header, 4, 2));
    for (std::size_t at = stream.begins.front(); at < stream.bytes.size(); at += 13) {
        StreamBytes damaged = stream;
        damaged.bytes.erase(at, 50);
        const Reading growing = read_growing(damaged);
        const Reading finished = read_bytes(damaged.bytes);
        EXPECT_EQ(growing.packets, finished.packets) << at;
        EXPECT_EQ(growing.report.missing_slots, finished.report.missing_slots) << at;
    }
}

/// Writes `bytes` to a file one by one, each when the reader waits for it.
class Camera {
  public:
    explicit Camera(std::string bytes) : bytes_(std::move(bytes)) { write_text(file_, ""); }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    WaitForMore wait() {
        return [this](std::uint64_t seen) {
            EXPECT_EQ(seen, written_);
            if (written_ == bytes_.size()) return false;
            std::ofstream(file_, std::ios::binary | std::ios::app) << bytes_[written_++];
            return true;
        };
    }

  private:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "clip.stipple";
    std::string bytes_;
    std::size_t written_ = 0;
};

TEST(GrowingTest, AFollowedFileIsReadFromItsFirstByteToItsEndMarker) {
    const StreamHeader header = varied_header();
    const auto packets = random_packets(header, 5, 2);
    Camera camera(bytes_of(header, packets).bytes + "never looked at");
    StreamReader reader(camera.file(), ReadPolicy::kStrict, camera.wait());
    EXPECT_EQ(reader.header(), header);
    EXPECT_EQ(reader.slots(), std::nullopt);
    EXPECT_EQ(read_packets(reader), packets);
    EXPECT_EQ(reader.slots(), 5);
    EXPECT_EQ(causes(reader.report()), "");
}

TEST(GrowingTest, AFollowedFileThatStopsGrowingEndsThere) {
    const StreamHeader header = varied_header();
    const auto packets = random_packets(header, 3, 4);
    const StreamBytes stream = bytes_of(header, packets);
    const std::string cut = stream.bytes.substr(0, stream.begins[2] + 40);
    Camera camera(cut);
    StreamReader tolerant(camera.file(), ReadPolicy::kTolerant, camera.wait());
    EXPECT_EQ(read_packets(tolerant).size(), 2U);
    EXPECT_EQ(tolerant.report().tail_bytes, 40U);
    EXPECT_EQ(causes(tolerant.report()), "");
    Camera again(cut);
    StreamReader strict(again.file(), ReadPolicy::kStrict, again.wait());
    expect_parts(message_of<InputError>([&] { return read_packets(strict); }),
                 {"ends within a packet", "40 bytes"});
}

TEST(GrowingTest, AFollowedFileThatNeverHoldsAHeaderIsRefused) {
    Camera camera(bytes_of(varied_header(), {}).bytes.substr(0, 70));
    expect_parts(message_of<InputError>([&] {
                     return StreamReader(camera.file(), ReadPolicy::kTolerant, camera.wait());
                 }),
                 {"ends within its header"});
}

TEST(GrowingTest, DamageInAFollowedFileCostsTheSameAsInAFinishedOne) {
    const StreamHeader header = varied_header();
    const StreamBytes stream = bytes_of(header, random_packets(header, 4, 2));
    for (std::size_t at = stream.begins.front(); at < stream.bytes.size(); at += 29) {
        std::string damaged = stream.bytes;
        damaged.erase(at, 50);
        Camera camera(damaged);
        StreamReader reader(camera.file(), ReadPolicy::kTolerant, camera.wait());
        EXPECT_EQ(read_packets(reader), read_bytes(damaged).packets) << at;
        EXPECT_EQ(reader.report().missing_slots, read_bytes(damaged).report.missing_slots) << at;
    }
}

TEST(GrowingTest, BytesAfterTheEndMarkerAreReportedOnce) {
    const StreamHeader header = varied_header();
    StreamBytes stream = bytes_of(header, random_packets(header, 2, 4));
    stream.bytes += std::string(100, 'x');
    const StreamReport report = read_growing(stream).report;
    EXPECT_EQ(causes(report), "bytes after the end marker\n");
    EXPECT_EQ(report.damage.front().offset, stream.begins.back());
    EXPECT_EQ(report.damage.front().bytes, 100U);
}

// Two packets of which the file holds no more than the headers, then a whole one: neither claim
// may hide what comes after it.
TEST(GrowingTest, AWholePacketBehindTwoCutOnesIsFound) {
    const StreamHeader header = varied_header({4, 200, 1}, 10);
    auto packets = random_packets(header, 3, 4);
    packets[2].flags = SamplePacket::kDropped;
    packets[2].dn.clear();
    const StreamBytes stream = bytes_of(header, packets);
    std::string bytes = stream.bytes.substr(0, stream.begins[0] + kPacketHeaderBytes);
    bytes += stream.bytes.substr(stream.begins[1], kPacketHeaderBytes);
    bytes += stream.bytes.substr(stream.begins[2], kPacketHeaderBytes);
    const TemporaryFolder folder;
    const Reading reading = read_bytes(bytes);
    ASSERT_EQ(reading.packets.size(), 1U);
    EXPECT_EQ(reading.packets.front(), packets[2]);
    EXPECT_EQ(reading.report.missing_slots, 2);
}

// The first packet has lost its payload, and the file never grows to the length it claims.
TEST(GrowingTest, APacketThatArrivesByteByByteBehindACutOneIsFound) {
    const StreamHeader header = varied_header({4, 200, 1}, 10);
    auto packets = random_packets(header, 2, 4);
    packets[1].flags = SamplePacket::kDropped;
    packets[1].dn.clear();
    StreamBytes stream = bytes_of(header, packets);
    const std::size_t begin = stream.begins[0] + kPacketHeaderBytes;
    stream.bytes =
        stream.bytes.erase(begin, stream.begins[1] - begin).substr(0, begin + kPacketHeaderBytes);
    const Reading reading = read_growing(stream);
    ASSERT_EQ(reading.packets.size(), 1U);
    EXPECT_EQ(reading.packets.front(), packets[1]);
    EXPECT_EQ(causes(reading.report), "bytes of a packet are missing\nslot 0 is missing\n");
}

TEST(GrowingTest, AnInterruptedRecordingReadsStrictlyButHasNoSlotCount) {
    const StreamHeader header = varied_header();
    const auto packets = random_packets(header, 3, 4);
    const TemporaryFolder folder;
    {
        StreamWriter writer(folder / "clip.stipple", header);
        for (const SamplePacket& packet : packets) writer.write(packet);
    }
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kStrict);
    EXPECT_EQ(reader.slots(), std::nullopt);
    EXPECT_EQ(read_packets(reader), packets);
    EXPECT_EQ(reader.report().slots, 3);
}

TEST(GrowingTest, ASlotThatIsNotFinishedEndsInADroppedPacket) {
    const StreamHeader header = varied_header({6, 8, 1});
    auto packets = random_packets(header, 3, 2);
    packets.resize(7);  // slot 2 has rows 0 and 1 only
    const TemporaryFolder folder;
    write_stream(folder / "clip.stipple", header, packets);
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kStrict);
    EXPECT_EQ(reader.slots(), 3);
    packets.push_back({2, 2, 4, SamplePacket::kDropped, {}});
    EXPECT_EQ(read_packets(reader), packets);
}

TEST(GrowingTest, APipeIsReadLikeAFile) {
    const StreamHeader header = varied_header();
    const auto packets = random_packets(header, 20, 2);
    const std::string bytes = bytes_of(header, packets).bytes;
    const TemporaryFolder folder;
    const auto pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::jthread camera([&] { write_text(pipe, bytes); });
    StreamReader reader(pipe, ReadPolicy::kStrict);
    EXPECT_EQ(reader.slots(), std::nullopt);
    EXPECT_EQ(read_packets(reader), packets);
}

}  // namespace
}  // namespace stipple
