#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "readout/stream_recorder.h"

namespace stipple {

/// Results of an emulation for programs: the keys of `emulate` in docs/outputs.md.
/// `slots_per_second` is empty if the speed is not known.
[[nodiscard]] nlohmann::ordered_json emulation_json(const StreamRecorder& recorder,
                                                    std::optional<double> slots_per_second);

/// The same in two lines for people.
[[nodiscard]] std::string emulation_text(const StreamRecorder& recorder,
                                         std::optional<double> slots_per_second);

}  // namespace stipple
