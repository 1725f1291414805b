#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/camera.h"
#include "capture/clock_fit.h"
#include "capture/frame_record.h"

namespace stipple {

/// The bytes of a recording (docs/recording_format.md): a magic, then blocks.
inline constexpr std::array<std::uint8_t, 16> kRecordingMagic{
    0x89, 'S', 'T', 'R', '\r', '\n', 0x1A, '\n', 1, 0, 0, 0, 0, 0, 0, 0};
inline constexpr std::size_t kRecordingVersionOffset = 8;

inline constexpr std::size_t kBlockHeaderBytes = 32;
inline constexpr std::size_t kFrameRecordBytes = 160;
inline constexpr std::size_t kHoleBytes = 16;
inline constexpr std::size_t kMaxHoles = 65536;
inline constexpr std::uint64_t kMaxTextBytes = std::uint64_t{1} << 26U;
inline constexpr std::uint64_t kMaxFramePayloadBytes = std::uint64_t{1} << 32U;

enum class BlockKind : std::uint32_t { kSession = 1, kFrame = 2, kEnd = 3 };

/// Header of a block.
struct BlockHeader {
    BlockKind kind = BlockKind::kFrame;
    std::uint32_t number = 0;        ///< of the block, from 0, modulo 2^32
    std::uint32_t record_bytes = 0;  ///< JSON, or a frame record and its holes
    std::uint64_t payload_bytes = 0;
    std::uint32_t record_crc = 0;

    [[nodiscard]] std::uint64_t block_bytes() const {
        return kBlockHeaderBytes + record_bytes + payload_bytes;
    }
};

/// First bytes of a block header.
inline constexpr std::array<std::uint8_t, 4> kBlockSync{0xC5, 'F', 'R', 'M'};

[[nodiscard]] std::array<std::uint8_t, kBlockHeaderBytes> encode_block_header(
    const BlockHeader& header);

/// The header at the start of `bytes`; empty if the sync word, the CRC or a limit is wrong.
/// Precondition: bytes.size() >= kBlockHeaderBytes.
[[nodiscard]] std::optional<BlockHeader> decode_block_header(std::span<const std::uint8_t> bytes);

/// The record of a frame and its holes. Further holes are merged into the hole number kMaxHoles.
/// Precondition: the layout has a format.
[[nodiscard]] std::vector<std::uint8_t> encode_frame_record(const CapturedFrame& frame);

/// Stores the hash of the payload in an encoded frame record.
void store_payload_hash(std::span<std::uint8_t> record, std::uint64_t hash);

/// Fills `frame.record` and `frame.holes`. Returns the fault of `bytes`, or an empty text.
[[nodiscard]] std::string decode_frame_record(std::span<const std::uint8_t> bytes,
                                              std::uint64_t payload_bytes, CapturedFrame& frame);

/// A field of the frame record: name and type string as NumPy has them.
struct RecordField {
    std::string_view name;
    std::string_view type;
    std::size_t offset = 0;  ///< of its first byte
};
/// All fields in order. They fill kFrameRecordBytes without gaps.
[[nodiscard]] std::span<const RecordField> frame_record_fields();

/// Content of the session block, at the beginning of a recording.
struct SessionRecord {
    CameraDescription camera = {};
    CameraSettings settings = {};                  ///< given by the user
    std::map<std::string, std::string> host = {};  ///< versions of kernel, libraries, program
    std::int64_t started_realtime_ns = 0;
};

/// Content of the end block.
struct RecordingEnd {
    std::string reason = "stopped";  ///< "stopped", "disk full", "camera lost", ...
    LostFrames lost = {};            ///< missing frames by GapCause
    TransportCounts transport = {};
    std::uint64_t frames = 0;      ///< in the file
    std::uint64_t incomplete = 0;  ///< of these with a status other than kComplete
    std::uint64_t payload_bytes = 0;
    std::vector<ClockFit> clocks = {};  ///< one per epoch, if the device has stamps
};

/// Kernel and architecture of this machine, for SessionRecord::host.
[[nodiscard]] std::map<std::string, std::string> host_facts();

/// JSON; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string encode_session(const SessionRecord& session);
[[nodiscard]] std::string encode_end(const RecordingEnd& end);
/// \throws InputError at `where` if the text is no JSON or has wrong types.
[[nodiscard]] SessionRecord decode_session(std::string_view text, std::string_view where);
[[nodiscard]] RecordingEnd decode_end(std::string_view text, std::string_view where);

}  // namespace stipple
