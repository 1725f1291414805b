#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/serve/frame_source.h"
#include "stream/framing.h"
#include "stream/packet_order.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

// A sample stream as the frames of a camera: each frame's payload is the packets of one slot, the
// very bytes of a .stipple file, and zeros up to the size that all payloads have.

/// Width of the image as which a payload goes out: Mono8, one byte a pixel.
inline constexpr int kCodedImageWidth = 1024;

/// The header of a coded stream, and what its packets have from it.
struct CodedHeader {
    StreamHeader stream;
    Framing framing;
};

/// That of a stream to be sent. \throws InputError as encode_header.
[[nodiscard]] CodedHeader coded_header(StreamHeader stream);

/// The image that holds the packets of any slot, and the header for clients.
/// \throws InputError if the header is too long to be read through registers (1 MiB).
[[nodiscard]] ServedImage coded_image(const StreamHeader& header);

/// The payload of a slot. Precondition: its packets fit (coded_image).
[[nodiscard]] std::vector<std::uint8_t> coded_payload(std::span<const SamplePacket> packets,
                                                      const CodedHeader& header,
                                                      const ServedImage& image);

/// What a payload holds.
struct CodedSlot {
    std::vector<SamplePacket> packets;
    std::string fault;  ///< why the bytes after the packets are none; empty if they are zeros
};

/// Packets are good if they follow `expected` and each other.
[[nodiscard]] CodedSlot decode_coded_payload(const CodedHeader& header,
                                             std::span<const std::uint8_t> payload,
                                             StreamPosition expected);

/// The header from its hexadecimal digits. \throws InputError at `place`.
[[nodiscard]] CodedHeader decode_coded_header(const std::string& digits, const std::string& place);

}  // namespace stipple
