#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

enum class ReadPolicy {
    kTolerant,  ///< damage costs its own samples and is reported
    kStrict,    ///< the first deviation from the format is an InputError
};

/// One place where a stream was damaged.
struct StreamDamage {
    std::uint64_t offset = 0;  ///< byte where the damage was found
    std::uint64_t bytes = 0;   ///< bytes skipped before the next good packet
    std::string cause;
};

struct StreamReport {
    std::uint64_t packets = 0;
    std::uint64_t samples = 0;
    std::uint64_t payload_bits = 0;
    std::int64_t slots = 0;          ///< 1 + the largest slot number seen
    std::int64_t missing_slots = 0;  ///< slots below `slots` with rows in no good packet
    std::vector<StreamDamage> damage;
};

/// Reads a sample stream packet by packet (docs/stream_format.md). Memory: one packet.
class StreamReader {
  public:
    /// \throws InputError naming file and offset if the file is missing, foreign, of an unknown
    /// version, or its header is damaged (without a header no sample has a meaning).
    explicit StreamReader(const std::filesystem::path& file,
                          ReadPolicy policy = ReadPolicy::kTolerant);
    ~StreamReader();
    StreamReader(StreamReader&&) noexcept;
    StreamReader& operator=(StreamReader&&) noexcept;

    [[nodiscard]] const StreamHeader& header() const;
    /// Slots in the file, where a good index at its end tells.
    [[nodiscard]] std::optional<std::int64_t> slots() const;

    /// Reads the next good packet in file order. Returns false at the last whole packet; if the
    /// file is still being written, a later call may succeed. \throws InputError (kStrict only).
    bool next(SamplePacket& packet);

    /// What has been read so far.
    [[nodiscard]] const StreamReport& report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
