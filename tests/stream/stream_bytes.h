#pragma once

#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stream/crc32c.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/packet_codec.h"
#include "tests/stream/stream_files.h"
#include "tests/support/memory_file.h"
#include "tests/support/temporary_folder.h"

namespace stipple {

/// The bytes of a stream, and where its parts begin: each packet, the index, the end marker, and
/// the end of the file.
struct StreamBytes {
    std::string bytes;
    std::vector<std::size_t> begins;

    /// CRC of the header, which those of packets continue.
    [[nodiscard]] std::uint32_t seed() const {
        std::uint32_t crc = 0;
        std::memcpy(&crc, &bytes[begins[0] - 4], 4);
        return crc;
    }
};

inline StreamBytes bytes_of(const StreamHeader& header, const std::vector<SamplePacket>& packets) {
    const TemporaryFolder folder;
    StreamBytes result;
    StreamWriter writer(folder / "clip.stipple", header);
    result.begins.push_back(writer.bytes_written());
    for (const SamplePacket& packet : packets) {
        writer.write(packet);
        result.begins.push_back(writer.bytes_written());
    }
    writer.finish();
    result.bytes = read_text(folder / "clip.stipple");
    result.begins.push_back(result.bytes.size() - kEndMarkerBytes);
    result.begins.push_back(result.bytes.size());
    return result;
}

inline std::span<std::uint8_t> as_numbers(std::string& bytes) {
    return {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()};
}

/// A packet with good CRCs, whatever its fields say.
inline std::string framed(const PacketHeader& header, const std::string& payload,
                          std::uint32_t seed) {
    std::string packet = std::string(kPacketHeaderBytes, '\0') + payload;
    frame_packet(header, as_numbers(packet), seed);
    return packet;
}

/// `stream` with the checksum of all packets that `original` has, and a good CRC of the end marker.
inline std::string with_checksum_of(const StreamBytes& original, const StreamBytes& stream) {
    std::string bytes = stream.bytes;
    const std::size_t marker = bytes.size() - kEndMarkerBytes;
    bytes.replace(marker + 12, 4, original.bytes, original.bytes.size() - 8, 4);
    const auto numbers = as_numbers(bytes);
    store(&numbers[marker + 16], crc32c(numbers.subspan(marker, 16), stream.seed()));
    return bytes;
}

/// Puts the good CRC at the end of a header.
inline void seal_header(std::string& header) {
    const auto numbers = as_numbers(header);
    store(&numbers[numbers.size() - 4], crc32c(numbers.first(numbers.size() - 4)));
}

/// All that a reader makes of a file.
struct Reading {
    std::vector<SamplePacket> packets;
    StreamReport report;
};

/// Reads `bytes` as a file. \throws InputError as StreamReader.
inline Reading read_bytes(const std::string& bytes, ReadPolicy policy = ReadPolicy::kTolerant) {
    const MemoryFile file(bytes);
    EXPECT_TRUE(file.good());
    StreamReader reader(file.path(), policy);
    Reading reading;
    reading.packets = read_packets(reader);
    reading.report = reader.report();
    return reading;
}

/// The causes of all damage, one a line.
inline std::string causes(const StreamReport& report) {
    std::string text;
    for (const StreamDamage& damage : report.damage) text += damage.cause + '\n';
    return text;
}

}  // namespace stipple
