#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "capture/capture_figures.h"
#include "capture/capture_session.h"

namespace stipple {

/// Frames that are missing, by cause: the key `lost` of docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json lost_json(const SessionTotals& totals);

/// The same for people: the causes there are, or "none".
[[nodiscard]] std::string lost_text(const SessionTotals& totals);

/// What the transport has counted: the key `transport` of docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json transport_json(const TransportCounts& counts);

/// How many, and how many are incomplete, for a line of progress: "3 lost, 1 incomplete"; empty if
/// all is well.
[[nodiscard]] std::string losses_text(const SessionTotals& totals);

/// \throws DeviceError if `losses` (a text as above) is not empty: `--fail-on-loss`.
void throw_if_lost(const std::string& losses, const std::string& file);

/// Tells on standard error that the camera is lost or back, or what is wrong at the end of a
/// replay.
void say_event(const SessionEvent& event);

/// Warns of what may cost frames.
void say_warnings(const CameraDescription& camera);

/// The keys of `capture live` in docs/outputs.md, without `preview`.
[[nodiscard]] nlohmann::ordered_json live_json(const LiveReport& report);

/// The same for people; slots are late after `late_after_slots`.
[[nodiscard]] std::string live_text(const LiveReport& report, const std::string& output,
                                    double late_after_slots);

}  // namespace stipple
