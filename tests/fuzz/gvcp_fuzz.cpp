#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "capture/serve/gige_device.h"
#include "capture/serve/gvcp_codec.h"
#include "tests/fuzz/require.h"

namespace stipple {
namespace {

ServedImage image() {
    ServedImage image;
    image.width = 64;
    image.height = 48;
    image.formats = {pixel_format_named("Mono8"), pixel_format_named("Mono16")};
    return image;
}

/// What the streaming thread relies on, whatever was written to the registers.
void check(const GigeDevice& device) {
    const GigeStreamSettings stream = device.stream();
    require(stream.format != nullptr);
    require(stream.width >= 1 && stream.height >= 1);
    require(stream.offset_x <= 64 && stream.width <= 64 - stream.offset_x);
    require(stream.offset_y <= 48 && stream.height <= 48 - stream.offset_y);
    require(stream.packet_bytes >= 128 && stream.packet_bytes <= 65535);
    require(stream.frames_hz >= 0.009 && stream.frames_hz <= 100000);
    require(!stream.running || device.controller());
    require(!stream.frames || *stream.frames > 0);
}

}  // namespace
}  // namespace stipple

/// Input: datagrams, each with a byte before it that says who sends it (bit 7), how much time goes
/// by before (bits 4 to 6) and, in sixteen bytes, how long it is (bits 0 to 3, and a byte).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    static const ServedImage kImage = image();
    GigeDevice device({}, kImage);
    GigeDevice::Time now{0};
    std::span<const std::uint8_t> rest(data, size);
    while (rest.size() >= 2) {
        const unsigned who = rest[0];
        const std::size_t length =
            std::min<std::size_t>((who & 0xFU) * 16U + rest[1] % 16U, rest.size() - 2);
        now += std::chrono::milliseconds(300 * (who >> 4U & 7U));
        const UdpEndpoint peer{0x7F000001, static_cast<std::uint16_t>(5000 + (who >> 7U))};
        if (const auto command = decode_gvcp(rest.subspan(2, length))) {
            const GigeOutcome outcome = device.execute(*command, peer, now);
            require(outcome.reply.size() <= kMaxGvcpBytes);
            require(outcome.reply.empty() || command->wants_reply);
        }
        check(device);
        rest = rest.subspan(2 + length);
    }
    return 0;
}
