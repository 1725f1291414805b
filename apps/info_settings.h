#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// What `name` is, if it is a sensor, a schedule, a rig or a scene: a file of settings by its keys,
/// a compiled schedule (.mem, .hex) by its extension, else a name of `stipple list`.
enum class SettingsKind { kNone, kSensor, kSchedule, kScene, kRig };

/// \throws InputError for a name that both a sensor and a schedule have, and for a .toml file whose
/// keys are of neither.
[[nodiscard]] SettingsKind settings_kind(const std::string& name);

/// `stipple info` of one of them. \throws InputError as its reader.
void info_settings(SettingsKind kind, const std::string& name, const RunOptions& run);

}  // namespace stipple
