#include "tests/stream/golden_cases.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "stream/slot_index.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/byte_edits.h"

namespace stipple {
namespace {

std::string feature(const StreamHeader& header, int slots, int band_rows) {
    return bytes_of(header, random_packets(header, slots, band_rows)).bytes;
}

std::string flags() {
    const StreamHeader header = varied_header({4, 4, 1});
    auto packets = random_packets(header, 3, 2);
    packets[2].flags = SamplePacket::kOverrun;
    packets[3].flags = SamplePacket::kDropped;
    packets[3].dn.clear();
    return bytes_of(header, packets).bytes;
}

std::string addressed_packet() {
    const StreamHeader header = varied_header({4, 4, 1});
    const StreamBytes stream = bytes_of(header, random_packets(header, 3, 4));
    PacketHeader packet;
    packet.kind = PacketKind::kAddressed;
    packet.slot = 1;
    packet.rows = 4;
    packet.samples = 1;
    const std::string sample("\x02\x00\x03\x00\x00\x01\xFF\x03", 8);
    std::string bytes = stream.bytes;
    return bytes.insert(stream.begins[2], framed(packet, sample, stream.seed()));
}

std::string calibrated_mosaic() {
    StreamHeader header = varied_header({4, 6, 1}, 12);
    header.cfa = ColourFilter::kGrbg;
    header.calibration.dark_e_per_slot = 1.5;
    header.calibration.tile = {2, 1, {{1, 1}, {0.25, 4}}};
    return feature(header, 4, 4);
}

/// Lengths that do not rise, two of them equal.
std::string random_order() {
    StreamHeader header = random_header({3, 4, 1}, 7);
    const std::vector<int> lengths{8, 1, 1, 4};
    header.schedule = random_schedule(3, 4, lengths, 7);
    header.schedule_source.exposure_slots = lengths;
    return feature(header, 16, 3);
}

std::vector<GoldenCase> features() {
    return {{"example", example_stream()},
            {"mono_10_bits", feature(varied_header({4, 5, 1}, 10), 6, 4)},
            {"mono_1_bit", feature(varied_header({4, 5, 1}, 1), 6, 4)},
            {"mono_16_bits", feature(varied_header({4, 5, 1}, 16), 6, 4)},
            {"colour_12_bits", feature(varied_header({3, 4, 3}, 12), 6, 3)},
            {"bands_of_rows", feature(varied_header({5, 4, 1}), 3, 2)},
            {"random_schedule", feature(random_header({3, 4, 1}, 20260101), 16, 3)},
            {"random_order", random_order()},
            {"two_planes", feature(varied_header({4, 4, 2}), 3, 4)},
            {"tile_larger_than_array", feature(varied_header({1, 2, 1}), 6, 1)},
            {"no_slots", feature(varied_header(), 0, 4)},
            {"calibrated_mosaic", calibrated_mosaic()},
            {"flags", flags()},
            {"addressed_packet", addressed_packet()}};
}

/// The first half of one stream and the second of another, whose samples differ.
std::string torn() {
    StreamHeader header = varied_header({4, 4, 1});
    auto packets = random_packets(header, 4, 4);
    const StreamBytes first = bytes_of(header, packets);
    header.provenance = "seed = 2\nfootage = \"Gänge\"\n";
    for (SamplePacket& packet : packets) std::ranges::reverse(packet.dn);
    return first.bytes.substr(0, first.begins[2]) +
           bytes_of(header, packets).bytes.substr(first.begins[2]);
}

/// The samples of slots 1 and 2 have changed places, and all CRCs are good.
std::string samples_exchanged() {
    StreamHeader header = varied_header({4, 4, 1});
    header.schedule = {1, 1, 1, {0, 1}, {{0, 1}}};
    auto packets = random_packets(header, 4, 4);
    const StreamBytes stream = bytes_of(header, packets);
    std::swap(packets[1].dn, packets[2].dn);
    return with_checksum_of(stream, bytes_of(header, packets));
}

/// Three slots of one packet each, with something done to them.
std::vector<GoldenCase> damages() {
    const StreamHeader header = varied_header({4, 4, 1});
    const StreamBytes whole = bytes_of(header, random_packets(header, 3, 4));
    const auto& begins = whole.begins;
    std::string twice = whole.bytes;
    twice.insert(begins[2], whole.bytes.substr(begins[1], begins[2] - begins[1]));
    return {{"interrupted", whole.bytes.substr(0, begins[3])},
            {"cut_in_packet", whole.bytes.substr(0, begins[3] - 1)},
            {"cut_in_header", whole.bytes.substr(0, begins[0] - 1)},
            {"damaged_header", flipped(whole.bytes, 40)},
            {"damaged_packet_header", flipped(whole.bytes, begins[1] + 8)},
            {"damaged_payload", flipped(whole.bytes, begins[1] + kPacketHeaderBytes)},
            {"damaged_index", flipped(whole.bytes, begins[3] + kPacketHeaderBytes)},
            {"damaged_end_marker", flipped(whole.bytes, begins[4])},
            {"missing_packet", without(whole.bytes, begins[1], begins[2])},
            {"missing_bytes", without(whole.bytes, begins[1] + 10, begins[1] + 20)},
            {"missing_end_of_last_packet", without(whole.bytes, begins[3] - 3, begins[3])},
            {"packet_twice", twice},
            {"torn", torn()},
            {"samples_exchanged", samples_exchanged()},
            {"bytes_after_end", whole.bytes + "more"}};
}

/// What is left of a stream of three bands a slot if bands are missing, or the writer or the file
/// ends within a slot.
std::vector<GoldenCase> parts_of_slots() {
    const StreamHeader header = varied_header({5, 4, 1});
    auto packets = random_packets(header, 3, 2);
    const StreamBytes whole = bytes_of(header, packets);
    packets.pop_back();
    std::string two_gaps = without(whole.bytes, whole.begins[2], whole.begins[8]);
    two_gaps.erase(whole.begins[0], whole.begins[1] - whole.begins[0]);
    return {
        {"partial_last_slot", whole.bytes.substr(0, whole.begins[8])},
        {"partial_last_slot_with_index", without(whole.bytes, whole.begins[8], whole.begins[9])},
        {"two_gaps_in_a_slot", two_gaps},
        {"stopped_within_slot", bytes_of(header, packets).bytes}};
}

PacketHeader packet_header_at(const std::string& bytes, std::size_t at) {
    std::string copy = bytes.substr(at, kPacketHeaderBytes);
    return decode_packet_header(as_numbers(copy));
}

/// Good CRCs for packet `i` of `whole`, which was changed in `bytes`.
std::string sealed(std::string bytes, const StreamBytes& whole, std::size_t i) {
    const std::size_t size = whole.begins[i + 1] - whole.begins[i];
    const std::string packet = bytes.substr(whole.begins[i], size);
    return bytes.replace(
        whole.begins[i], size,
        framed(packet_header_at(packet, 0), packet.substr(kPacketHeaderBytes), whole.seed()));
}

/// An index that leads to another place than a slot, one whose offsets do not rise (which counts
/// after damage too), and an end marker that leads elsewhere.
std::vector<GoldenCase> wrong_offsets(const StreamBytes& whole) {
    const auto [index, marker] = std::pair{whole.begins[3], whole.begins[4]};
    const std::size_t first_offset = index + kPacketHeaderBytes + 8;
    std::string order = whole.bytes;
    std::swap_ranges(&order[first_offset], &order[first_offset + 8],
                     &order[first_offset + kIndexEntryBytes]);
    order = flipped(sealed(order, whole, 3), whole.begins[0] + kPacketHeaderBytes);
    std::string offset = whole.bytes;
    const auto numbers = as_numbers(offset);
    store(&numbers[marker + 4], std::uint64_t{whole.begins[2]});
    store(&numbers[marker + 16], crc32c(numbers.subspan(marker, 16), whole.seed()));
    return {{"wrong_index_entry", sealed(flipped(whole.bytes, first_offset), whole, 3)},
            {"index_out_of_order_after_damage", order},
            {"wrong_end_marker", offset}};
}

/// Rules of docs/stream_format.md that the cases above leave out.
std::vector<GoldenCase> rules() {
    const StreamHeader header = varied_header({4, 4, 1});
    const StreamBytes whole = bytes_of(header, random_packets(header, 3, 4));
    const auto& begins = whole.begins;
    const auto packet = [&](std::size_t i) {
        return whole.bytes.substr(begins[i], begins[i + 1] - begins[i]);
    };
    std::string reserved = whole.bytes;
    PacketHeader fields = packet_header_at(reserved, begins[1]);
    fields.switches = 1;
    reserved.replace(begins[1], begins[2] - begins[1],
                     framed(fields, packet(1).substr(kPacketHeaderBytes), whole.seed()));
    std::string after_index = whole.bytes;
    after_index.insert(begins[4], packet(2));
    const std::string no_start =
        flipped(whole.bytes.substr(0, begins[3] + 10), begins[2] + kPacketHeaderBytes);
    std::vector<GoldenCase> cases{
        {"reserved_not_zero", reserved},
        {"unused_bits_not_zero", sealed(flipped(whole.bytes, begins[2] - 1), whole, 1)},
        {"packet_after_index", after_index},
        {"no_start_after_damage", no_start},
        {"cut_in_end_marker", whole.bytes.substr(0, whole.bytes.size() - 1)}};
    for (auto& more : {wrong_offsets(whole), parts_of_slots()})
        cases.insert(cases.end(), more.begin(), more.end());
    return cases;
}

}  // namespace

std::string example_stream() {
    const ExposureSchedule schedule(1, 2, 2, {0, 2, 3}, {{0, 0b1}, {1, 0b1}, {0, 0b11}});
    StreamHeader header{{2, 2, 1}, 5000, {}, schedule, {}, "example", "seed = 1\n"};
    header.calibration = {.bit_depth = 10, .black_level_dn = 64, .gain_e_per_dn = 20};
    return bytes_of(header, {{0, 0, 2, 0, {1023, 1}}, {1, 0, 2, 0, {512, 3, 4, 0}}}).bytes;
}

std::vector<GoldenCase> golden_cases() {
    std::vector<GoldenCase> cases = features();
    for (const auto& more : {damages(), rules()})
        cases.insert(cases.end(), more.begin(), more.end());
    return cases;
}

std::vector<GoldenCase> golden_cases_3() {
    const StreamHeader weighted = weighted_header();
    StreamHeader calibrated = weighted;
    calibrated.calibration.dark_e_per_slot = 1.5;
    calibrated.calibration.noise_free = true;
    StreamHeader exact = varied_header({4, 6, 1}, 16);
    exact.calibration.noise_free = true;
    const StreamBytes stream = bytes_of(weighted, random_packets(weighted, 7, 4));
    const std::size_t weights = stream.begins[0] - 4 - 4 * weighted.schedule.weights().size();
    const auto with_weight = [&](std::size_t slot, std::size_t pixel, float weight) {
        std::string header = stream.bytes.substr(0, stream.begins[0]);
        store(&as_numbers(header)[weights + 4 * (slot * 6 + pixel)], weight);
        seal_header(header);
        return header + stream.bytes.substr(stream.begins[0]);
    };
    return {{"weighted", stream.bytes},
            {"weighted_and_calibrated", feature(calibrated, 7, 4)},
            {"noise_free", feature(exact, 7, 4)},
            {"weight_of_a_closed_slot", with_weight(2, 0, 0.5F)},
            {"weight_below_its_limit", with_weight(3, 0, 0x1p-21F)}};
}

}  // namespace stipple
