#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/recording/recording_format.h"
#include "core/message.h"

namespace stipple {

/// One damaged place of a recording.
struct RecordingDamage {
    std::uint64_t offset = 0;  ///< byte where the damage was found
    std::uint64_t bytes = 0;   ///< bytes skipped up to the next good block
    std::string cause;
};

struct RecordingReport {
    static constexpr std::size_t kMaxListedDamage = kMaxListedFaults;

    std::uint64_t frames = 0;          ///< delivered
    std::uint64_t missing_blocks = 0;  ///< by the numbers of the blocks
    std::uint64_t tail_bytes = 0;      ///< of an unfinished block at the end
    std::vector<RecordingDamage> damage;
    std::uint64_t unlisted_damage = 0;  ///< number of further places, when `damage` is full
};

/// True if `path` is a regular file that begins with the magic of a recording.
[[nodiscard]] bool is_recording(const std::filesystem::path& path);

/// Reads a recording frame by frame (docs/recording_format.md). Damage is reported and costs only
/// the frames that it affects. Memory: one frame.
class RecordingReader {
  public:
    /// \throws InputError if the file is missing, no recording, or of an unknown version.
    explicit RecordingReader(std::filesystem::path file);
    ~RecordingReader();
    RecordingReader(RecordingReader&&) noexcept;
    RecordingReader& operator=(RecordingReader&&) noexcept;

    /// Empty if the session block is damaged; the frames are still readable.
    [[nodiscard]] const SessionRecord& session() const;
    /// Reads the next good frame. Returns false at the end of the file. \throws InputError if the
    /// file cannot be read, or consists of overlapping blocks.
    bool next(CapturedFrame& frame);
    /// The end record, after `next` has returned false; empty if the recording was cut off.
    [[nodiscard]] const std::optional<RecordingEnd>& end() const;
    [[nodiscard]] const RecordingReport& report() const;
    /// Faults of the file, after `next` has returned false: damage, missing end. Empty if there are
    /// none.
    [[nodiscard]] std::vector<std::string> faults() const;
    /// Starts again at the first frame, with a new report. Not possible with a pipe.
    void rewind();

  private:
    struct Impl;
    std::filesystem::path file_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
