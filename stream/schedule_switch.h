#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/schedule_parts.h"
#include "stream/stream_header.h"

namespace stipple {

/// The switches of a stream are at most so many, and rows x columns x switches at most this.
inline constexpr std::size_t kMaxSwitches = 65535;
inline constexpr std::uint64_t kMaxPixelSwitches = std::uint64_t{1} << 32U;

/// The number of the last switch that is known; 0 before the first one.
[[nodiscard]] inline int last_switch(const StreamHeader& stream) {
    return stream.switches.empty() ? 0 : stream.switches.back().number;
}

[[nodiscard]] ReadoutValues readout_values(const Calibration& calibration);
[[nodiscard]] Calibration with_values(Calibration calibration, const ReadoutValues& values);

/// The calibration of samples that are read in `slot`, by the switches that are known.
[[nodiscard]] Calibration calibration_at(const StreamHeader& stream, std::int64_t slot);

/// The schedules of a stream, by the switches that are known. `stream` must outlive them unchanged.
[[nodiscard]] std::vector<SchedulePart> schedule_parts(const StreamHeader& stream);

/// The one that holds in `slot`; it does not say whether it follows.
[[nodiscard]] SchedulePart schedule_at(const StreamHeader& stream, std::int64_t slot);

/// Follows the switches of a stream, for which exposures under way must not become too long.
class JoinedExposures {
  public:
    /// Sets next.longest_span_slots, or returns why `next` cannot follow the switches of `stream`:
    /// interleaved exposures, weights, or an exposure of more than 64 slots. Precondition: since
    /// the last call switches were added to `stream` or removed at its end.
    [[nodiscard]] std::optional<std::string> fault(const StreamHeader& stream,
                                                   ScheduleSwitch& next);

  private:
    std::optional<UnreadSlots> unread_;
    std::vector<std::int64_t> passed_;  ///< slots of the switches that `unread_` has passed
};

/// The payload of the packet of a switch. \throws InputError at `where` if a value is outside its
/// limits, or as encode_schedule.
[[nodiscard]] std::vector<std::uint8_t> encode_switch(const ScheduleSwitch& next, FrameShape shape,
                                                      std::string_view where);

/// The inverse, without slot and number. \throws InputError naming the byte of the payload, or as
/// check_memory.
struct ScheduleUse;
[[nodiscard]] ScheduleSwitch decode_switch(std::span<const std::uint8_t> payload, FrameShape shape,
                                           std::string_view where, const ScheduleUse& use);

}  // namespace stipple
