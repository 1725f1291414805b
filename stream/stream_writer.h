#pragma once

#include <filesystem>
#include <memory>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Writes a sample stream, append-only: every prefix is a valid stream up to its last whole packet.
class StreamWriter {
  public:
    /// Creates the file and writes the header. \throws InputError if a header field is outside its
    /// limits, DeviceError if the file cannot be written.
    StreamWriter(const std::filesystem::path& file, const StreamHeader& header);
    ~StreamWriter();
    StreamWriter(const StreamWriter&) = delete;
    StreamWriter& operator=(const StreamWriter&) = delete;

    /// Appends a packet. Precondition: `dn` holds what the schedule predicts for its slot and rows
    /// (or nothing, if dropped), each below 2^bit_depth. \throws DeviceError (full disk).
    void write(const SamplePacket& packet);
    /// Writes the index and closes. \throws DeviceError.
    void finish();

    [[nodiscard]] std::uint64_t bytes_written() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
