#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/recording/recording_format.h"

namespace stipple {

/// One place where a recording was damaged.
struct RecordingDamage {
    std::uint64_t offset = 0;  ///< byte where the damage was found
    std::uint64_t bytes = 0;   ///< bytes skipped before the next good block
    std::string cause;
};

struct RecordingReport {
    static constexpr std::size_t kMaxListedDamage = 1000;

    std::uint64_t frames = 0;          ///< delivered
    std::uint64_t missing_blocks = 0;  ///< that the numbers of the blocks say are gone
    std::uint64_t tail_bytes = 0;      ///< of a block that the file ends in the midst of
    std::vector<RecordingDamage> damage;
    std::uint64_t unlisted_damage = 0;  ///< further places, when `damage` is full
};

/// True if `path` is a regular file that begins as a recording does.
[[nodiscard]] bool is_recording(const std::filesystem::path& path);

/// Reads a recording frame by frame (docs/recording_format.md). Damage costs the frames that it
/// hits and is reported. Memory: one frame.
class RecordingReader {
  public:
    /// \throws InputError if the file is missing, no recording, or of an unknown version.
    explicit RecordingReader(std::filesystem::path file);
    ~RecordingReader();
    RecordingReader(RecordingReader&&) noexcept;
    RecordingReader& operator=(RecordingReader&&) noexcept;

    /// Empty if it is damaged; frames can be read even so.
    [[nodiscard]] const SessionRecord& session() const;
    /// Reads the next good frame. Returns false at the end of the file. \throws InputError if the
    /// file cannot be read, or is made of overlapping blocks.
    bool next(CapturedFrame& frame);
    /// The end record, once `next` has returned false; nothing if the recording was cut off.
    [[nodiscard]] const std::optional<RecordingEnd>& end() const;
    [[nodiscard]] const RecordingReport& report() const;
    /// What is wrong with the file, once `next` has returned false: damage, no end. Empty if
    /// nothing is.
    [[nodiscard]] std::vector<std::string> faults() const;
    /// Begins again with the first frame; the report too. Not possible with a pipe.
    void rewind();

  private:
    struct Impl;
    std::filesystem::path file_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
