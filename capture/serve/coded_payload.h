#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/serve/frame_source.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

// A sample stream as the frames of a camera. The payload of a frame is the packets of one slot,
// with the same bytes as in a .stipple file, then zeros up to the payload size.

/// Width of the Mono8 image that carries a payload, one byte per pixel.
inline constexpr int kCodedImageWidth = 1024;

/// The header of a coded stream, and the framing of its packets that depends on it.
struct CodedHeader {
    StreamHeader stream;
    Framing framing;
};

/// The header of a stream to be sent. \throws InputError as encode_header.
[[nodiscard]] CodedHeader coded_header(StreamHeader stream);

/// An image large enough for the packets of any slot, and the header for clients.
/// \throws InputError if the header is too long to be read through registers (1 MiB).
[[nodiscard]] ServedImage coded_image(const StreamHeader& header);

/// The payload of a slot. Precondition: its packets fit (coded_image).
[[nodiscard]] std::vector<std::uint8_t> coded_payload(std::span<const SamplePacket> packets,
                                                      const CodedHeader& header,
                                                      const ServedImage& image);

/// Content of a payload.
struct CodedSlot {
    std::vector<SamplePacket> packets;
    std::string fault;  ///< why the bytes after the packets are no packet; empty if zeros
};

/// Packets are good if they follow `expected` and each other in order.
[[nodiscard]] CodedSlot decode_coded_payload(const CodedHeader& header,
                                             std::span<const std::uint8_t> payload,
                                             StreamPosition expected);

/// The header from its hexadecimal digits. \throws InputError at `where`.
[[nodiscard]] CodedHeader decode_coded_header(const std::string& digits, const std::string& where);

}  // namespace stipple
