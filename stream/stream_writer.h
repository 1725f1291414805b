#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Writes a sample stream, append-only: every prefix is a valid stream up to its last whole packet,
/// and each packet can be read as soon as `write` returns.
class StreamWriter {
  public:
    /// Creates the file and writes the header. Messages call the output `where` (default: the
    /// path), for a file that is renamed when it is complete. \throws InputError if a header field
    /// is outside its limits, DeviceError if the file cannot be written.
    /// With `first_slot` the file lacks the slots before it, and is a piece of a stream.
    StreamWriter(const std::filesystem::path& file, const StreamHeader& header,
                 std::string where = {}, std::int64_t first_slot = 0);
    ~StreamWriter();
    StreamWriter(const StreamWriter&) = delete;
    StreamWriter& operator=(const StreamWriter&) = delete;

    /// Appends a packet. Precondition: packets come by slot from the first on and by row, no gaps;
    /// `dn` has one DN for each due pixel and plane of its slot and rows (none if dropped), each
    /// below 2^bit_depth. \throws DeviceError (full disk).
    void write(const SamplePacket& packet);
    /// From the next slot on the schedule and the readout values are those of `next`, whose slot
    /// and number this sets. The switch is written twice, before and after the samples of that
    /// slot. Precondition: header.may_switch; the last slot has all its rows and is not the first
    /// one. \throws InputError if the values are outside their limits, if the schedule has weights
    /// or interleaved exposures, or if an exposure under way would have more than 64 slots: then
    /// the stream goes on as before. DeviceError. Returns it as a reader will know it.
    const ScheduleSwitch& switch_schedule(ScheduleSwitch next);
    /// Marks the missing rows of the last slot as dropped, writes the index and closes the file. No
    /// call of `write` may follow. \throws DeviceError.
    void finish();

    [[nodiscard]] std::uint64_t bytes_written() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
