#include "capture/serve/coded_payload.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/error.h"
#include "stream/bit_packing.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/packet_codec.h"
#include "stream/sample_codec.h"

namespace stipple {
namespace {

constexpr const char* kWhere = "the coded stream";  ///< in messages
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 20U;
constexpr std::size_t kScheduleCrcAt = 88;  ///< docs/stream_format.md, "Header"
/// A slot is one packet of samples, or two where rows are dropped.
constexpr std::size_t kMaxPackets = 2;

std::string hexadecimal(std::span<const std::uint8_t> bytes) {
    std::string digits;
    digits.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes)
        for (const unsigned nibble : {unsigned{byte} >> 4U, byte & 0xFU})
            digits += "0123456789abcdef"[nibble];
    return digits;
}

int digit_value(char digit) {
    if (digit >= '0' && digit <= '9') return digit - '0';
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    return -1;
}

/// Samples of the slot that has most. Later periods are like the second.
std::size_t max_samples(const StreamHeader& header) {
    std::size_t max_due = 0;
    const std::int64_t period = header.schedule.period_slots();
    for (std::int64_t slot = period; slot < 2 * period; ++slot)
        max_due = std::max(
            max_due, count_due(header.schedule, slot, 0, header.shape.rows, header.shape.cols));
    return max_due * static_cast<std::size_t>(header.shape.planes);
}

}  // namespace

CodedHeader coded_header(StreamHeader stream) {
    const Framing framing = framing_of(encode_header(stream, kWhere));
    return {std::move(stream), framing};
}

ServedImage coded_image(const StreamHeader& header) {
    const auto encoded = encode_header(header, kWhere);
    if (encoded.size() > kMaxHeaderBytes)
        throw InputError(kWhere,
                         fmt::format("its header has {} bytes, a client can read {} through "
                                     "registers; choose a schedule with a smaller tile",
                                     encoded.size(), kMaxHeaderBytes));
    const std::size_t bytes = kMaxPackets * kPacketHeaderBytes +
                              packed_bytes(max_samples(header), header.calibration.bit_depth);
    ServedImage image;
    image.width = kCodedImageWidth;
    image.height = static_cast<int>((bytes + kCodedImageWidth - 1) / kCodedImageWidth);
    image.formats = {pixel_format_named("Mono8")};
    image.croppable = false;
    image.frames_hz = 1e6 / header.slot_us;
    image.exposure_map_id = load<std::uint32_t>(&encoded[kScheduleCrcAt]);
    image.coded_header = hexadecimal(encoded);
    return image;
}

std::vector<std::uint8_t> coded_payload(std::span<const SamplePacket> packets,
                                        const CodedHeader& header, const ServedImage& image) {
    const std::size_t size =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<std::uint8_t> payload;
    payload.reserve(size);
    for (const SamplePacket& packet : packets) {
        const auto bytes =
            encode_samples(packet, header.stream.calibration.bit_depth, header.framing.seed);
        payload.insert(payload.end(), bytes.begin(), bytes.end());
    }
    assert(payload.size() <= size);
    payload.resize(size);
    return payload;
}

CodedSlot decode_coded_payload(const CodedHeader& header, std::span<const std::uint8_t> payload,
                               StreamPosition expected) {
    CodedSlot slot;
    while (!payload.empty() && payload.front() != 0) {
        DecodedSamples decoded = decode_samples(header.stream, header.framing, payload, expected);
        if (!decoded.fault.empty()) {
            slot.fault = std::move(decoded.fault);
            return slot;
        }
        payload = payload.subspan(decoded.bytes);
        const int end_row = decoded.packet.first_row + decoded.packet.rows;
        expected = end_row == header.stream.shape.rows
                       ? StreamPosition{decoded.packet.slot + 1, 0}
                       : StreamPosition{decoded.packet.slot, end_row};
        slot.packets.push_back(std::move(decoded.packet));
    }
    if (slot.packets.empty()) slot.fault = "it holds no packet";
    return slot;
}

CodedHeader decode_coded_header(const std::string& digits, const std::string& where) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
        const int high = digit_value(digits[i]);
        const int low = digit_value(digits[i + 1]);
        if (high < 0 || low < 0) throw InputError(where, "is not a hexadecimal number");
        bytes.push_back(static_cast<std::uint8_t>(16 * high + low));
    }
    if (bytes.size() < kHeaderStartBytes || header_bytes(bytes, where) != bytes.size())
        throw InputError(where, "is not a whole header of a sample stream");
    return {decode_header(bytes, where), framing_of(bytes)};
}

}  // namespace stipple
