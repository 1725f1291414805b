#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stream/buffered_reader.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/schedule_switch.h"
#include "stream/slot_index.h"
#include "stream/stream_opening.h"

namespace stipple {

/// The switches of the schedule that a reader meets: keeps those of `stream.header`.
class SwitchTrack {
  public:
    /// `stream` and `where`, the name in messages, must outlive it. `input_bytes` as check_memory.
    SwitchTrack(StreamOpening& stream, const std::string& where, std::uint64_t input_bytes)
        : stream_(stream), where_(where), input_bytes_(input_bytes) {}

    /// Without this a switch is an error.
    void follow() { follows_ = true; }

    /// Takes a switch packet with correct CRCs, or returns what is wrong with it. A copy of the
    /// last one is good and changes nothing. \throws InputError if switches are not followed, if
    /// the reader has a calibration of its sites and the readout values change, and as
    /// check_memory.
    [[nodiscard]] std::optional<std::string> take(const PacketHeader& found,
                                                  std::span<const std::uint8_t> payload,
                                                  StreamPosition expected);
    /// Makes those up to a place known. False if one cannot be read; then fewer are known.
    [[nodiscard]] bool reach(const IndexPlace& place, const BufferedReader& file);
    /// Forgets those after `slot`.
    void forget_after(std::int64_t slot);

    /// Of the last schedule; null if schedules are not counted.
    [[nodiscard]] const DueCounts* counts() const;

  private:
    /// What a switch adds to its packet.
    struct Taken {
        PacketHeader packet;
        std::optional<DueCounts> counts;
    };
    void check(const ScheduleSwitch& next) const;

    StreamOpening& stream_;
    const std::string& where_;
    std::uint64_t input_bytes_;
    bool follows_ = false;
    JoinedExposures joined_;
    std::vector<Taken> taken_;  ///< one for each of stream.header.switches
};

}  // namespace stipple
