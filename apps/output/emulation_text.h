#pragma once

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "readout/stream_recorder.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"
#include "stream/stream_header.h"

namespace stipple {

/// Results of an emulation for programs: the keys of `emulate` in docs/outputs.md.
/// `slots_per_second` is empty if the speed is not known.
[[nodiscard]] nlohmann::ordered_json emulation_json(const StreamRecorder& recorder,
                                                    std::optional<double> slots_per_second);

/// The same in two lines for people.
[[nodiscard]] std::string emulation_text(const StreamRecorder& recorder,
                                         std::optional<double> slots_per_second);

/// Readout cost of a recording, for programs: the key `readout` of `emulate` in docs/outputs.md.
/// `light_throughput` is that of schedule and filters.
[[nodiscard]] nlohmann::ordered_json readout_json(const ReadoutCost& cost, double light_throughput);

/// The same in a few lines for people.
[[nodiscard]] std::string readout_text(const ReadoutCost& cost);

/// How fast a sensor reads, for programs: the keys of `timing` in docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json rate_json(const ReadoutRate& rate, const ReadoutCost& cost);

/// The same as a table for people.
[[nodiscard]] std::string rate_text(const ReadoutRate& rate, const ReadoutCost& cost);

/// Warning that most samples of the file `name` are DN 0, where their noise is cut off; else empty.
/// Empty too for a NaN, of no samples.
[[nodiscard]] inline std::string zero_warning(const std::string& name, double zero_fraction,
                                              const Calibration& calibration) {
    if (!(zero_fraction > 0.5) || calibration.black_level_dn > 0) return {};
    return fmt::format(
        "{}: {:.2g} % of the samples are DN 0, as there is little light and no black level: their "
        "noise is cut off, and what is dark cannot be decoded exactly; give more light, or a "
        "black level (key black_level_dn of sensors in physical mode)",
        name, 100 * zero_fraction);
}

}  // namespace stipple
