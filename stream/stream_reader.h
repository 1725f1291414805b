#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

enum class ReadPolicy {
    kTolerant,  ///< damage costs its own samples and is reported
    kStrict,    ///< the first deviation from the format is an InputError
    /// As kTolerant, but a packet may have any number of samples up to one per site. For the search
    /// of the schedule that the samples follow.
    kAnySchedule,
    /// As kTolerant, for callers that use no samples. A random schedule (20 bytes of a header can
    /// expand to 800 MB) is counted row by row but not stored: the schedule of `header` has a tile
    /// of one pixel, with the figures of the whole schedule.
    kCounts,
};

/// One place where a stream was damaged.
struct StreamDamage {
    std::uint64_t offset = 0;  ///< byte where the damage was found
    std::uint64_t bytes = 0;   ///< bytes skipped before the next good packet
    std::string cause;
};

struct StreamReport {
    static constexpr std::size_t kMaxListedDamage = kMaxListedFaults;

    int version = 0;  ///< of the format, docs/stream_format.md
    std::uint64_t packets = 0;
    std::uint64_t samples = 0;
    std::uint64_t payload_bits = 0;
    /// 1 + the slot of the last packet, or the number in the index once it was read. Up to 2^53 in
    /// a crafted file, so memory and time must not depend on it.
    std::int64_t slots = 0;
    std::int64_t missing_slots = 0;  ///< slots with missing rows before the last packet read
    /// True once the end marker has been read: the file is whole and will not grow.
    bool complete = false;
    std::uint64_t tail_bytes = 0;  ///< of an incomplete packet at the end of the file
    /// Left out, as their number of samples is not that of the due pixels: the chip may have run
    /// another schedule.
    std::uint64_t unexpected_packets = 0;
    std::vector<StreamDamage> damage;
    std::uint64_t unlisted_damage = 0;  ///< further places, when `damage` is full
};

/// Called if a growing file has no further whole packet; `bytes` of it have been read. It waits for
/// more bytes and returns true to read again, or false if the file ends here.
using WaitForMore = std::function<bool(std::uint64_t bytes)>;

/// True if `path` is a regular file that begins with the magic of a stream.
[[nodiscard]] bool is_stream(const std::filesystem::path& path);

/// Reads a sample stream packet by packet (docs/stream_format.md). Memory: one packet.
class StreamReader {
  public:
    /// \throws InputError naming file and offset if the file is missing, is no sample stream, has
    /// an unknown version or a damaged header; as check_memory if its schedule is too large. With
    /// `wait` the file is followed while it grows: the constructor waits for the header, `next` for
    /// whole packets, until the end marker comes or `wait` returns false.
    explicit StreamReader(const std::filesystem::path& file,
                          ReadPolicy policy = ReadPolicy::kTolerant, WaitForMore wait = {});
    ~StreamReader();
    StreamReader(StreamReader&&) noexcept;
    StreamReader& operator=(StreamReader&&) noexcept;

    /// With the switches that `next` has met, or `seek` has passed.
    [[nodiscard]] const StreamHeader& header() const;
    /// Name of the stream in messages: the path of its file, or that of `use_name`.
    [[nodiscard]] const std::string& name() const;
    void use_name(std::string name);
    /// Size of the file, as check_memory takes it: kEndlessInput of a pipe and of a file that is
    /// followed.
    [[nodiscard]] std::uint64_t input_bytes() const;
    /// Replaces the schedule of the file for later calls of `header` and `next`.
    /// Precondition: no packet has been read.
    void use_schedule(ExposureSchedule schedule);
    /// Sets `header().sites` and `header().response`. Precondition: no packet has been read; no
    /// site, or one calibration for each; an empty table, or a number for each DN of the bit depth.
    void use_sites(std::vector<SiteCalibration> sites, ResponseTable response = {});
    /// For callers that take the schedule and the values of each slot from `header().switches`
    /// (schedule_switch.h). Without this `next` and `seek` refuse a stream whose schedule changes.
    void follow_switches();
    /// Number of slots in the stream. Known at once if the file ends with a good index (then less
    /// than the bytes of the file / 36, since each slot has a packet), else once the end marker has
    /// been read. Nothing if the stream was interrupted, is still growing, or comes through a pipe.
    [[nodiscard]] std::optional<std::int64_t> slots() const;

    /// Moves to the last slot that is not after `slot` and whose place is known, by a good index at
    /// the end of the file or since it was read, and returns it; else to the beginning, 0. The
    /// report begins anew: the packets before are not in it, and the checksum of all packets is not
    /// checked. A stream that is followed or comes through a pipe stays where it is, and 0 is
    /// returned. \throws InputError if the file cannot be read.
    std::int64_t seek(std::int64_t slot);

    /// Reads the next good packet in file order. Returns false at the last whole packet; if the
    /// file is still being written, a later call may succeed. \throws InputError (kStrict only;
    /// if the file cannot be read; at a switch of the schedule, see follow_switches).
    bool next(SamplePacket& packet);

    /// Report on the bytes read so far.
    [[nodiscard]] const StreamReport& report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What distinguishes a whole stream from others, from its header and its end alone: the CRC of the
/// header and the checksum of all packets, as text. Nothing if the file has no good end, or is of
/// version 1. Damaged copies of a stream have the same. \throws InputError if it is no stream.
[[nodiscard]] std::optional<std::string> stream_identity(const std::filesystem::path& file);

}  // namespace stipple
