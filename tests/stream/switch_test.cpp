// Streams of version 4, whose schedule changes between two slots.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "core/error.h"
#include "tests/stream/switched_stream.h"
#include "tests/support/byte_edits.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Packets = std::vector<SamplePacket>;

struct Followed {
    Packets packets;
    StreamReport report;
    StreamHeader header;
};

Followed follow(const std::string& bytes, ReadPolicy policy = ReadPolicy::kTolerant) {
    const MemoryFile file(bytes);
    StreamReader reader(file.path(), policy);
    reader.follow_switches();
    Packets packets = read_packets(reader);
    return {std::move(packets), reader.report(), reader.header()};
}

/// Those of `all` that are not in `packets`, by slot.
std::vector<std::int64_t> lost(const Packets& all, const Packets& packets) {
    std::vector<std::int64_t> slots;
    for (const SamplePacket& packet : all)
        if (std::ranges::find(packets, packet) == packets.end()) slots.push_back(packet.slot);
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
}

TEST(SwitchTest, AStreamComesBackWithItsSwitches) {
    const SwitchedStream s = switched_stream();
    EXPECT_EQ(s.stream.bytes[8], 4);
    for (const ReadPolicy policy : {ReadPolicy::kStrict, ReadPolicy::kTolerant}) {
        Followed read = follow(s.stream.bytes, policy);
        EXPECT_EQ(read.packets, s.packets);
        ASSERT_EQ(read.header.switches.size(), 2U);
        for (ScheduleSwitch& part : read.header.switches) {
            EXPECT_GE(std::exchange(part.longest_span_slots, 0),
                      part.schedule.longest_span_slots());
        }
        EXPECT_EQ(read.header, s.header);
        EXPECT_TRUE(read.report.complete);
        EXPECT_EQ(read.report.version, 4);
    }
    const Followed counted = follow(s.stream.bytes, ReadPolicy::kCounts);
    EXPECT_EQ(counted.packets, s.packets);
    EXPECT_EQ(causes(counted.report), "");
}

TEST(SwitchTest, ItsValuesAreThoseOfEachSlot) {
    const SwitchedStream s = switched_stream();
    EXPECT_EQ(calibration_at(s.header, 12), s.header.calibration);
    Calibration last = s.header.calibration;
    last.gain_e_per_dn = 100;
    last.rounding = Rounding::kFloor;
    EXPECT_EQ(calibration_at(s.header, 13), last);
    EXPECT_EQ(*schedule_at(s.header, 5).schedule, gapped_schedule());
    EXPECT_EQ(*schedule_at(s.header, 6).schedule, random_header({4, 6, 1}, 5).schedule);
}

TEST(SwitchTest, AReaderThatDoesNotFollowRefusesAtTheSwitch) {
    const SwitchedStream s = switched_stream();
    const MemoryFile file(s.stream.bytes);
    StreamReader reader(file.path());
    SamplePacket packet;
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(reader.next(packet));
    expect_parts(message_of<InputError>([&] { return reader.next(packet); }),
                 {"its schedule changes at slot 6"});
    expect_parts(message_of<InputError>([&] { return StreamReader(file.path()).seek(15); }),
                 {"its schedule changes at slot 6"});
}

TEST(SwitchTest, WithoutASwitchTheStreamIsOneOfAnySchedule) {
    const StreamHeader header = switching_header();
    const Packets packets = random_packets(header, 8, 2);
    const StreamBytes stream = bytes_of(header, packets);
    const Reading reading = read_bytes(stream.bytes, ReadPolicy::kStrict);
    EXPECT_EQ(reading.packets, packets);
    EXPECT_TRUE(reading.report.complete);
}

TEST(SwitchTest, AStreamWithTheHeaderOfAnotherBeginsWithoutItsSwitches) {
    const SwitchedStream s = switched_stream();
    StreamHeader header = switching_header();
    const Packets packets = random_packets(header, 8, 2);
    header.switches = s.header.switches;
    EXPECT_EQ(bytes_of(header, packets).bytes, bytes_of(switching_header(), packets).bytes);
}

TEST(SwitchTest, ASeekKnowsTheSwitchesBefore) {
    const SwitchedStream s = switched_stream();
    const TemporaryFolder folder;
    write_text(folder / "clip.stipple", s.stream.bytes);
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kStrict);
    reader.follow_switches();
    for (const std::int64_t slot : {15, 6, 5, 12, 13, 0, 19, 7}) {
        EXPECT_EQ(reader.seek(slot), slot);
        EXPECT_EQ(reader.header().switches.size(), slot < 6 ? 0U : slot < 13 ? 1U : 2U);
        Packets expected = s.packets;
        std::erase_if(expected, [&](const SamplePacket& packet) { return packet.slot < slot; });
        EXPECT_EQ(read_packets(reader), expected) << slot;
    }
}

TEST(SwitchTest, WithoutAnIndexASeekGoesBackOverSwitches) {
    const SwitchedStream s = switched_stream();
    const TemporaryFolder folder;
    write_text(folder / "clip.stipple", s.stream.bytes.substr(0, s.stream.bytes.size() - 1));
    StreamReader reader(folder / "clip.stipple");
    reader.follow_switches();
    EXPECT_EQ(read_packets(reader), s.packets);
    for (const std::int64_t slot : {14, 7, 3}) {
        EXPECT_EQ(reader.seek(slot), slot);
        EXPECT_EQ(lost(s.packets, read_packets(reader)).size(), static_cast<std::size_t>(slot));
    }
}

TEST(SwitchTest, OfADamagedSwitchTheCopyIsTaken) {
    const SwitchedStream s = switched_stream();
    const std::size_t first = s.stream.begins[s.own[0]], copy = s.stream.begins[s.own[1]];
    for (const std::size_t at : {std::size_t{8}, kPacketHeaderBytes + 50}) {
        const Followed read = follow(flipped(s.stream.bytes, first + at));
        EXPECT_EQ(lost(s.packets, read.packets), std::vector<std::int64_t>{6});
        EXPECT_EQ(read.report.missing_slots, 1);
        EXPECT_NE(causes(read.report).find("follows switch 1 of the schedule, but switch 0"),
                  std::string::npos);
        EXPECT_EQ(follow(flipped(s.stream.bytes, copy + at)).packets, s.packets);
    }
    EXPECT_EQ(lost(s.packets,
                   follow(without(s.stream.bytes, first, s.stream.begins[s.own[0] + 1])).packets),
              std::vector<std::int64_t>{6});
}

TEST(SwitchTest, WithoutBothCopiesTheSamplesUpToTheNextSwitchAreLost) {
    const SwitchedStream s = switched_stream();
    std::string bytes = s.stream.bytes;
    for (const std::size_t own : {s.own[0], s.own[1]})
        bytes = flipped(bytes, s.stream.begins[own] + 8);
    const Followed read = follow(bytes);
    EXPECT_EQ(lost(s.packets, read.packets), (std::vector<std::int64_t>{6, 7, 8, 9, 10, 11, 12}));
    ASSERT_EQ(read.header.switches.size(), 1U);
    EXPECT_EQ(read.header.switches[0].number, 2);
    EXPECT_FALSE(schedule_parts(read.header)[1].follows);
}

TEST(SwitchTest, NoBitOfASwitchMayChange) {
    const SwitchedStream s = switched_stream();
    for (const std::size_t own : s.own)
        for (std::size_t at = s.stream.begins[own]; at < s.stream.begins[own + 1]; ++at) {
            const Followed read = follow(flipped(s.stream.bytes, at));
            EXPECT_FALSE(read.report.damage.empty()) << at;
            EXPECT_LE(lost(s.packets, read.packets).size(), 1U) << at;
            for (const SamplePacket& packet : read.packets)
                EXPECT_NE(std::ranges::find(s.packets, packet), s.packets.end()) << at;
        }
}

/// A stream with the packet at `begins[i]` changed, its CRCs correct.
template <typename Change>
std::string changed(const SwitchedStream& s, std::size_t i, const Change& change) {
    std::string bytes = s.stream.bytes;
    const std::size_t begin = s.stream.begins[i], end = s.stream.begins[i + 1];
    const auto packet = as_numbers(bytes).subspan(begin, end - begin);
    PacketHeader header = decode_packet_header(packet);
    change(header, packet.subspan(kPacketHeaderBytes));
    frame_packet(header, packet, s.stream.seed());
    return bytes;
}

TEST(SwitchTest, EachRuleOfASwitchHolds) {
    const SwitchedStream s = switched_stream();
    const auto cause = [&](const auto& change) {
        return follow(changed(s, s.own[0], change)).report.damage.front().cause;
    };
    const auto number = [](std::size_t offset, auto value) {
        return
            [=](PacketHeader&, std::span<std::uint8_t> payload) { store(&payload[offset], value); };
    };
    EXPECT_EQ(cause([](auto& packet, auto) { packet.flags = 1; }),
              "flags, rows or samples of a switch are not zero");
    EXPECT_EQ(cause([](auto& packet, auto) { packet.samples = 1; }),
              "flags, rows or samples of a switch are not zero");
    EXPECT_EQ(cause([](auto& packet, auto) { packet.slot = kMaxSlot + 1; }),
              "slot 9007199254740992 is not below 2^53");
    EXPECT_EQ(cause([](auto& packet, auto) { packet.slot = 5; }),
              "switch 1 at slot 5 comes twice or too late");
    EXPECT_EQ(cause([](auto& packet, auto) { packet.switches = 0; }),
              "switch 0 at slot 6 comes twice or too late");
    EXPECT_NE(cause(number(8, 0.0)).find("gain in electrons per DN 0 is outside"),
              std::string::npos);
    EXPECT_NE(cause(number(40, std::uint8_t{2})).find("rounding 2 is outside"), std::string::npos);
    EXPECT_NE(cause(number(41, std::uint8_t{2})).find("unknown schedule kind"), std::string::npos);
    EXPECT_NE(cause(number(42, std::uint16_t{60})).find("the name exceeds"), std::string::npos);
    EXPECT_NE(cause(number(44, std::uint32_t{60})).find("not the one that was recorded"),
              std::string::npos);
    EXPECT_NE(cause(number(48, std::uint8_t{7})).find("schedule name is not UTF-8"),
              std::string::npos);
}

TEST(SwitchTest, SamplesAndIndexTellTheSwitchesBeforeThem) {
    const SwitchedStream s = switched_stream();
    const auto cause = [&](std::size_t i, int switches) {
        const auto read = follow(changed(s, i, [&](auto& packet, auto) {
            packet.switches = static_cast<std::uint16_t>(switches);
        }));
        return read.report.damage.front().cause;
    };
    EXPECT_EQ(cause(3, 1), "it follows switch 1 of the schedule, but switch 0 was read last");
    EXPECT_EQ(cause(s.own[0] + 1, 0),
              "it follows switch 0 of the schedule, but switch 1 was read last");
    const std::size_t index = s.stream.begins.size() - 3;
    EXPECT_EQ(cause(index, 1), "the index counts 1 switches of the schedule");
    EXPECT_EQ(cause(index, 3), "23 index entries in 352 bytes");
    const auto wrong = changed(s, index, [](PacketHeader& packet, std::span<std::uint8_t> payload) {
        store(&payload[std::size_t{16} * packet.samples + 8], load<std::uint64_t>(&payload[8]));
    });
    EXPECT_EQ(follow(wrong).report.damage.front().cause,
              "the index says that slot 6 has a switch at byte " +
                  std::to_string(s.stream.begins[0]) + ", but it has not");
}

TEST(SwitchTest, TheWriterRefusesWhatDoesNotFit) {
    const TemporaryFolder folder;
    StreamHeader header = switching_header();
    header.schedule = {1, 1, 40, {0, 1}, {{0, open_without_gap(40)}}};
    StreamWriter writer(folder / "clip.stipple", header);
    for (int slot = 0; slot < 38; ++slot) writer.write(random_packet(header, slot, 0, 4));
    const std::uint64_t bytes = writer.bytes_written();
    const auto refusal = [&](const ScheduleSwitch& next) {
        return message_of<InputError>([&] { writer.switch_schedule(next); });
    };
    ScheduleSwitch next = switch_to(header);
    next.schedule = {1, 1, 33, {0, 1}, {{0, open_without_gap(33)}}};
    expect_parts(refusal(next), {"switch at slot 38", "exposure of 66 slots up to slot 65"});
    next.schedule = varied_schedule();
    expect_parts(refusal(next), {"interleaved"});
    next.schedule = weighted_header().schedule;
    expect_parts(refusal(next), {"weights"});
    next.schedule = header.schedule;
    next.values.gain_e_per_dn = 0;
    expect_parts(refusal(next), {"gain"});
    EXPECT_EQ(writer.bytes_written(), bytes);
    next.values.gain_e_per_dn = 1;
    writer.switch_schedule(next);
    expect_parts(refusal(next), {"slot 38 has a switch"});
    writer.write({38, 0, 4, SamplePacket::kDropped, {}});
    writer.finish();
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kStrict);
    reader.follow_switches();
    EXPECT_EQ(read_packets(reader).size(), 39U);
    EXPECT_EQ(reader.header().switches.at(0).longest_span_slots, 40);
}

TEST(SwitchTest, AHeaderWithWeightsOrInterleavedExposuresCannotSwitch) {
    StreamHeader header = weighted_header();
    header.may_switch = true;
    const auto refusal = [&] {
        return message_of<InputError>([&] { return encode_header(header, "a"); });
    };
    expect_parts(refusal(), {"a: byte 8: version 4 has no interleaved exposures"});
    header.schedule = {1, 1, 1, {0, 1}, {{0, 1}}};
    header.schedule.set_weights({0.5F});
    expect_parts(refusal(), {"a: byte 86: version 4 has no weights"});
}

TEST(SwitchTest, AGrowingStreamIsFollowedOverSwitches) {
    const SwitchedStream s = switched_stream();
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    write_text(file, s.stream.bytes.substr(0, s.stream.begins.front()));
    StreamReader reader(file);
    reader.follow_switches();
    std::ofstream end(file, std::ios::binary | std::ios::app);
    Packets packets;
    SamplePacket packet;
    for (std::size_t at = s.stream.begins.front(); at < s.stream.bytes.size(); ++at) {
        end << s.stream.bytes[at] << std::flush;
        while (reader.next(packet)) packets.push_back(packet);
    }
    EXPECT_EQ(packets, s.packets);
    EXPECT_EQ(causes(reader.report()), "");
    EXPECT_TRUE(reader.report().complete);
}

}  // namespace
}  // namespace stipple
