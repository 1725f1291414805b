#include <cstdint>

#include "tests/stream/golden_cases.h"
#include "tests/stream/switched_stream.h"
#include "tests/support/byte_edits.h"

namespace stipple {
namespace {

constexpr std::size_t kVersionAt = 8;

/// A stream of version 3 or 2 that says that it is one of version 4.
std::string called_version_4(const StreamHeader& header) {
    const StreamBytes stream = bytes_of(header, random_packets(header, 2, 4));
    std::string start = stream.bytes.substr(0, stream.begins[0]);
    start[kVersionAt] = 4;
    seal_header(start);
    return start + stream.bytes.substr(stream.begins[0]);
}

StreamHeader weighted_without_interleaving() {
    StreamHeader header = weighted_header();
    header.schedule = {1, 1, 2, {0, 1}, {{0, 0b11}}};
    header.schedule.set_weights({0.5F, 1});
    return header;
}

/// The switch at `begins[own]` in a slot that was there before, with correct CRCs.
std::string switch_too_late(const SwitchedStream& s) {
    std::string bytes = s.stream.bytes;
    for (const std::size_t own : {s.own[0], s.own[1]}) {
        const std::size_t begin = s.stream.begins[own], end = s.stream.begins[own + 1];
        const auto packet = as_numbers(bytes).subspan(begin, end - begin);
        PacketHeader header = decode_packet_header(packet);
        header.slot = 5;
        frame_packet(header, packet, s.stream.seed());
    }
    return bytes;
}

}  // namespace

std::vector<GoldenCase> golden_cases_4() {
    const SwitchedStream s = switched_stream();
    const auto& begins = s.stream.begins;
    const std::string first = flipped(s.stream.bytes, begins[s.own[0]] + kPacketHeaderBytes);
    const StreamHeader without = switching_header({4, 5, 3});
    return {{"switched", s.stream.bytes},
            {"without_a_switch", bytes_of(without, random_packets(without, 7, 4)).bytes},
            {"cut_after_a_switch", s.stream.bytes.substr(0, begins[s.own[2] + 1])},
            {"damaged_switch", first},
            {"lost_switch", flipped(first, begins[s.own[1]] + 6)},
            {"switch_too_late", switch_too_late(s)},
            {"weighted", called_version_4(weighted_without_interleaving())},
            {"interleaved", called_version_4(varied_header({4, 6, 1}))}};
}

}  // namespace stipple
