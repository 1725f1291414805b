#include <algorithm>
#include <string>

#include "capture/serve/coded_payload.h"
#include "core/error.h"
#include "stream/little_endian.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/stream_pieces.h"

namespace stipple {
namespace {

using View = std::span<const std::uint8_t>;

std::string hexadecimal(View bytes) {
    std::string digits;
    for (const unsigned byte : bytes)
        for (const unsigned nibble : {byte >> 4U, byte & 0xFU})
            digits += "0123456789abcdef"[nibble];
    return digits;
}

/// What is taken for good is what a served camera could have sent: it comes back from a payload of
/// its own.
void take_slots(const CodedHeader& header, View payload) {
    const CodedSlot slot = decode_coded_payload(header, payload, {});
    require(slot.packets.empty() ? !slot.fault.empty() : true);
    StreamPosition expected;
    for (const SamplePacket& packet : slot.packets) {
        require(StreamPosition{packet.slot, packet.first_row} >= expected);
        require(packet.rows > 0 && packet.first_row + packet.rows <= header.stream.shape.rows);
        require(packet.dn.size() <= header.stream.shape.sites());
        expected = {packet.slot, packet.first_row + packet.rows};
    }
    if (slot.packets.empty() || slot.packets.size() > 2 ||
        slot.packets.front().slot != slot.packets.back().slot ||
        header.stream.shape.pixels() > 4096 || header.stream.schedule.period_slots() > 256)
        return;
    const ServedImage image = coded_image(header.stream);
    const auto again = coded_payload(slot.packets, header, image);
    require(decode_coded_payload(header, again, {}).packets == slot.packets);
}

}  // namespace
}  // namespace stipple

/// Input: a stream. A camera gives its header as digits; what follows is the payload of a frame.
/// What is no stream is taken for the digits.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const View bytes(data, size);
    try {
        std::size_t header = 0;
        if (size >= kStreamHeadBytes && data[0] == 0x89) {
            if (asks_for_much(bytes)) return 0;
            header = std::min<std::size_t>(size, load<std::uint32_t>(&data[12]));
        }
        const std::string digits =
            header > 0 ? hexadecimal(bytes.first(header)) : std::string(data, data + size);
        take_slots(decode_coded_header(digits, "fuzz"), bytes.subspan(header));
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
