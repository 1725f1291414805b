#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// What `name` is, if it is a sensor, a schedule, a rig, a space of `stipple explore` or a scene: a
/// file of settings by its keys, a compiled schedule (.mem, .hex) by its extension, else a name of
/// config/ or of a scene.
enum class SettingsKind { kNone, kSensor, kSchedule, kScene, kRig, kSpace };

/// \throws InputError for a name that both a sensor and a schedule have, and for a .toml file whose
/// keys are of none of them.
[[nodiscard]] SettingsKind settings_kind(const std::string& name);

/// `stipple info` of one of them. \throws InputError as its reader.
void info_settings(SettingsKind kind, const std::string& name, const RunOptions& run);

}  // namespace stipple
