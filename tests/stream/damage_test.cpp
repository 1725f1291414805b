#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/byte_edits.h"

namespace stipple {
namespace {

using Packets = std::vector<SamplePacket>;
using std::to_string;

/// Four slots of two bands each.
struct SmallStream {
    StreamHeader header = varied_header({4, 5, 1}, 10);
    Packets packets = random_packets(header, 4, 2);
    StreamBytes stream = bytes_of(header, packets);

    /// Begin of the part that holds byte `at`.
    [[nodiscard]] std::size_t begin_of(std::size_t at) const {
        return *(std::ranges::upper_bound(stream.begins, at) - 1);
    }
};

/// True if `part` is `whole` with some left out.
bool is_subsequence(const Packets& part, const Packets& whole) {
    auto next = whole.begin();
    for (const SamplePacket& packet : part) {
        next = std::find(next, whole.end(), packet);
        if (next++ == whole.end()) return false;
    }
    return true;
}

TEST(DamageTest, EveryPrefixReadsUpToItsLastWholePacket) {
    const SmallStream s;
    const auto& begins = s.stream.begins;
    for (std::size_t cut = begins.front(); cut < s.stream.bytes.size(); ++cut) {
        const auto [packets, report] = read_bytes(s.stream.bytes.substr(0, cut));
        const std::size_t whole = std::min<std::size_t>(
            static_cast<std::size_t>(std::ranges::upper_bound(begins, cut) - begins.begin()) - 1,
            s.packets.size());
        EXPECT_EQ(packets, Packets(s.packets.begin(),
                                   s.packets.begin() + static_cast<std::ptrdiff_t>(whole)));
        EXPECT_EQ(report.tail_bytes, cut - s.begin_of(cut)) << cut;
        EXPECT_EQ(causes(report), "") << cut;
        EXPECT_EQ(report.missing_slots, 0);
    }
}

TEST(DamageTest, AStrictReaderRefusesEveryPrefixThatIsNotWholePackets) {
    const SmallStream s;
    for (std::size_t cut = s.stream.begins.front(); cut < s.stream.bytes.size(); ++cut) {
        const std::string prefix = s.stream.bytes.substr(0, cut);
        if (s.begin_of(cut) == cut)
            EXPECT_NO_THROW(read_bytes(prefix, ReadPolicy::kStrict));
        else
            expect_parts(
                message_of<InputError>([&] { return read_bytes(prefix, ReadPolicy::kStrict); }),
                {": byte " + to_string(s.begin_of(cut)) + ": ", "the file ends within a packet"});
    }
}

TEST(DamageTest, APrefixOfTheHeaderIsRefused) {
    const SmallStream s;
    for (std::size_t cut = 0; cut < s.stream.begins.front(); ++cut)
        expect_parts(
            message_of<InputError>([&] { return read_bytes(s.stream.bytes.substr(0, cut)); }),
            {": byte " + to_string(cut) + ": ", "file"});
}

TEST(DamageTest, ADamagedByteOfTheHeaderIsFatal) {
    const SmallStream s;
    for (std::size_t at = 0; at < s.stream.begins.front(); ++at) {
        const std::string bytes = flipped(s.stream.bytes, at);
        expect_parts(message_of<InputError>([&] { return read_bytes(bytes); }), {": byte "});
    }
}

TEST(DamageTest, ADamagedByteCostsItsOwnPacketAndIsReported) {
    const SmallStream s;
    for (std::size_t at = s.stream.begins.front(); at < s.stream.bytes.size(); ++at)
        for (const int mask : {0x01, 0x80, 0xFF}) {
            const auto [packets, report] = read_bytes(flipped(s.stream.bytes, at, mask));
            Packets expected = s.packets;
            for (std::size_t i = 0; i < s.packets.size(); ++i)
                if (s.stream.begins[i] == s.begin_of(at))
                    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(i));
            EXPECT_EQ(packets, expected) << at;
            ASSERT_FALSE(report.damage.empty()) << at;
            EXPECT_EQ(report.damage.front().offset, s.begin_of(at));
            const bool lost = packets.size() < s.packets.size();
            EXPECT_EQ(report.missing_slots, lost ? 1 : 0) << at;
        }
}

TEST(DamageTest, AStrictReaderNamesTheDamagedPacket) {
    const SmallStream s;
    for (std::size_t at = s.stream.begins.front(); at < s.stream.bytes.size(); ++at) {
        const std::string bytes = flipped(s.stream.bytes, at, 0x40);
        expect_parts(message_of<InputError>([&] { return read_bytes(bytes, ReadPolicy::kStrict); }),
                     {": byte " + to_string(s.begin_of(at)) + ": "});
    }
}

TEST(DamageTest, BytesThatAreMissingCostThePacketsTheyBelongTo) {
    const SmallStream s;
    const std::size_t index = s.stream.begins[s.packets.size()];
    for (std::size_t at = s.stream.begins.front(); at < index; at += 3)
        for (const std::size_t length : {1U, 20U, 36U, 100U}) {
            const std::size_t end = std::min(at + length, index);
            const std::string bytes = without(s.stream.bytes, at, end);
            Packets expected;
            for (std::size_t i = 0; i < s.packets.size(); ++i)
                if (s.stream.begins[i + 1] <= at || s.stream.begins[i] >= end)
                    expected.push_back(s.packets[i]);
            const auto [packets, report] = read_bytes(bytes);
            EXPECT_EQ(packets, expected) << at << " " << length;
            EXPECT_FALSE(report.damage.empty());
            EXPECT_EQ(report.slots, 4);
        }
}

TEST(DamageTest, ForeignBytesBetweenPacketsCostNothing) {
    const SmallStream s;
    const std::string foreign = "\xC5SPK and then something else";
    for (const std::size_t begin : s.stream.begins) {
        std::string bytes = s.stream.bytes;
        bytes.insert(begin, foreign);
        const auto [packets, report] = read_bytes(bytes);
        EXPECT_EQ(packets, s.packets) << begin;
        ASSERT_EQ(report.damage.size(), 1U) << causes(report);
        EXPECT_EQ(report.damage.front().offset, begin);
        EXPECT_EQ(report.damage.front().bytes, foreign.size());
        EXPECT_EQ(report.missing_slots, 0);
    }
}

// Whatever happens to a file: no crash, and each packet that is delivered was recorded.
TEST(DamageTest, NoMutationBringsAWrongSample) {
    const SmallStream s;
    const std::size_t begin = s.stream.begins.front();
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
        std::string bytes = s.stream.bytes;
        const auto words = philox4x32({trial, 0, 0, 0}, 1);
        for (std::uint32_t i = 0; i <= words[0] % 4; ++i) {
            const auto [at_word, length_word, kind, value] = philox4x32({trial, i, 1, 0}, 1);
            const std::size_t at = begin + at_word % (bytes.size() - begin);
            const std::size_t length = 1 + length_word % 60;
            if (kind % 3 == 0) bytes.erase(at, length);
            if (kind % 3 == 1) bytes.insert(at, length, static_cast<char>(value));
            if (kind % 3 == 2) bytes.insert(at, bytes.substr(at / 2, length));
        }
        const auto [packets, report] = read_bytes(bytes);
        EXPECT_TRUE(is_subsequence(packets, s.packets)) << "trial " << trial;
        EXPECT_LE(report.missing_slots, 4);
    }
}

TEST(DamageTest, TheReportSaysWhatIsMissing) {
    const SmallStream s;
    const auto& begins = s.stream.begins;
    const auto missing = [&](std::size_t first, std::size_t end) {
        return causes(read_bytes(without(s.stream.bytes, begins[first], begins[end])).report);
    };
    EXPECT_EQ(missing(1, 2), "rows 2..3 of slot 0 are missing\n");
    EXPECT_EQ(missing(2, 4), "slot 1 is missing\n");
    EXPECT_EQ(missing(2, 6), "slots 1..2 are missing\n");
    EXPECT_EQ(missing(1, 5), "slot 0 from row 2 to slot 2 row 1 is missing\n");
    EXPECT_EQ(missing(6, 8), "slot 3 is missing\n");
}

TEST(DamageTest, APacketThatComesTwiceOrTooLateIsReported) {
    const SmallStream s;
    const auto& begins = s.stream.begins;
    const std::string second = s.stream.bytes.substr(begins[1], begins[2] - begins[1]);
    std::string bytes = s.stream.bytes;
    bytes.insert(begins[4], second);
    const auto [packets, report] = read_bytes(bytes);
    EXPECT_EQ(packets, s.packets);
    EXPECT_EQ(causes(report), "slot 0 row 2 comes twice or too late\n");
    EXPECT_EQ(report.damage.front().bytes, second.size());
}

TEST(DamageTest, OnlySoManyPlacesAreListed) {
    const StreamHeader header = varied_header({2, 3, 1}, 8);
    StreamBytes stream = bytes_of(header, random_packets(header, 1200, 2));
    for (std::size_t i = 0; i < 1200; i += 2) stream.bytes[stream.begins[i] + 10] = 'x';
    const auto [packets, report] = read_bytes(stream.bytes);
    EXPECT_EQ(packets.size(), 600U);
    EXPECT_EQ(report.missing_slots, 600);
    // Each of them is a damaged packet and a gap.
    EXPECT_EQ(report.damage.size(), StreamReport::kMaxListedDamage);
    EXPECT_EQ(report.unlisted_damage, 1200 - StreamReport::kMaxListedDamage);
}

// 60 000 headers, each of which claims the rest of a file of 2 MB: 60 GB of CRC if it were done.
TEST(DamageTest, OverlappingPacketsDoNotMakeTheWorkQuadratic) {
    const SmallStream s;
    std::string bytes = s.stream.bytes.substr(0, s.stream.begins.front());
    const std::size_t end = bytes.size() + 60000 * kPacketHeaderBytes;
    while (bytes.size() < end) {
        const std::size_t rest = end - bytes.size() - kPacketHeaderBytes;
        std::string packet(kPacketHeaderBytes, '\0');
        frame_packet({}, as_numbers(packet), s.stream.seed());
        const auto numbers = as_numbers(packet);
        store(&numbers[24], static_cast<std::uint32_t>(rest));
        store(&numbers[28], 0x12345678U);
        store(&numbers[32], crc32c(numbers.first(32), s.stream.seed()));
        bytes += packet;
    }
    expect_parts(message_of<InputError>([&] { return read_bytes(bytes); }),
                 {": byte ", "too many damaged packets overlap"});
}

}  // namespace
}  // namespace stipple
