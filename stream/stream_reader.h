#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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
    /// As kTolerant, but packets may hold other samples than the schedule says, up to one a site:
    /// to find out which schedule they follow.
    kAnySchedule,
    /// As kTolerant, for those who look at no samples: a random schedule, of which 20 bytes of a
    /// header can make 800 MB, is gone over and counted, but not kept. The schedule of `header` has
    /// a tile of one pixel then, and the figures of the whole.
    kCounts,
};

/// One place where a stream was damaged.
struct StreamDamage {
    std::uint64_t offset = 0;  ///< byte where the damage was found
    std::uint64_t bytes = 0;   ///< bytes skipped before the next good packet
    std::string cause;
};

struct StreamReport {
    static constexpr std::size_t kMaxListedDamage = 1000;

    int version = 0;  ///< of the format, docs/stream_format.md
    std::uint64_t packets = 0;
    std::uint64_t samples = 0;
    std::uint64_t payload_bits = 0;
    /// 1 + the slot of the last packet, or the number in the index once it was read. Up to 2^53 in
    /// a crafted file: no measure for memory or time.
    std::int64_t slots = 0;
    std::int64_t missing_slots = 0;  ///< with rows that are missing before the last packet read
    /// The end marker has been read: nothing was cut off, and nobody is writing any more.
    bool complete = false;
    std::uint64_t tail_bytes = 0;  ///< of a packet that the file ends in the midst of
    std::vector<StreamDamage> damage;
    std::uint64_t unlisted_damage = 0;  ///< further places, when `damage` is full
};

/// Called where a file that is still being written holds no further whole packet; `bytes` of it
/// have been seen. It waits for more and returns true to look again, false if the file ends here.
using WaitForMore = std::function<bool(std::uint64_t bytes)>;

/// Reads a sample stream packet by packet (docs/stream_format.md). Memory: one packet.
class StreamReader {
  public:
    /// \throws InputError naming file and offset if the file is missing, foreign, of an unknown
    /// version, or its header is damaged (without a header no sample has a meaning); as
    /// check_memory if its schedule is too large. With `wait` the file is followed while it grows:
    /// the constructor waits for the header, `next` for whole packets, until the end marker comes
    /// or `wait` returns false.
    explicit StreamReader(const std::filesystem::path& file,
                          ReadPolicy policy = ReadPolicy::kTolerant, WaitForMore wait = {});
    ~StreamReader();
    StreamReader(StreamReader&&) noexcept;
    StreamReader& operator=(StreamReader&&) noexcept;

    [[nodiscard]] const StreamHeader& header() const;
    /// From here on `header` and `next` go by another schedule than the one in the file.
    /// Precondition: no packet has been read.
    void use_schedule(ExposureSchedule schedule);
    /// Number of slots in the recording, known at once if a good index at the end of the file says
    /// so (then below the bytes of the file / 36, since each slot takes a packet), else once the
    /// end marker has been read; nothing if the recording was interrupted, goes on, or comes
    /// through a pipe.
    [[nodiscard]] std::optional<std::int64_t> slots() const;

    /// Reads the next good packet in file order. Returns false at the last whole packet; if the
    /// file is still being written, a later call may succeed. \throws InputError (kStrict only;
    /// and if the file cannot be read).
    bool next(SamplePacket& packet);

    /// What has been read so far.
    [[nodiscard]] const StreamReport& report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
