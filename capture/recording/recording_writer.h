#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "capture/recording/recording_format.h"
#include "stream/append_file.h"

namespace stipple {

/// Writes a recording (docs/recording_format.md): frames in their wire format, a record each. Every
/// prefix of the file is readable up to its last whole frame. Used from one thread.
class RecordingWriter {
  public:
    /// Creates the file and writes the session record. Messages call the output `place` (default:
    /// the path), for a file that is renamed when it is complete. \throws DeviceError.
    RecordingWriter(const std::filesystem::path& file, const SessionRecord& session,
                    std::string place = {});

    /// Appends a frame; the hash of its payload is computed here. Precondition: its layout has a
    /// format and at most 65535 x 65535 pixels, holes rise and lie in the payload.
    /// \throws DeviceError (full disk): the file then ends with the frame before, `finish` may
    /// still be called, and the file is readable with or without.
    void write(const CapturedFrame& frame);

    /// Writes the end record and closes; nothing may be written after. `end` brings the reason, the
    /// losses and the counts of the transport; frames, bytes and clocks are filled in here.
    /// \throws DeviceError.
    void finish(RecordingEnd end);

    /// What `finish` writes, so far: frames, incomplete, payload bytes, clocks; and the losses as
    /// the frames tell them.
    [[nodiscard]] RecordingEnd totals() const;
    [[nodiscard]] std::uint64_t frames() const { return totals_.frames; }
    [[nodiscard]] std::uint64_t bytes_written() const { return file_.bytes(); }

  private:
    void append_block(BlockKind kind, std::span<const std::uint8_t> record,
                      std::span<const std::uint8_t> payload);
    void count(const FrameRecord& record, std::size_t payload_bytes);

    AppendFile file_;
    std::uint32_t blocks_ = 0;
    RecordingEnd totals_;
    std::vector<ClockFitter> clocks_;
};

}  // namespace stipple
