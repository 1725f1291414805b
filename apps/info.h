#pragma once

#include <optional>
#include <string>

#include "apps/arguments/run_options.h"
#include "io/raw_format.h"

namespace stipple {

/// Prints the chip, the precision and the pattern of a calibration. \throws InputError if it is
/// damaged, DeviceError.
void info_calibration(const std::string& file, const RunOptions& run);

/// True if `source` is footage by its kind: a folder, a pattern, or a file with the extension of an
/// image, video, array or camera file.
[[nodiscard]] bool is_footage(const std::string& source);

/// `stipple info` of footage. Reads all frames unless `header_only`. \throws InputError as
/// FootageReader, after the figures up to the fault.
void info_footage(const std::string& source, const std::optional<RawFormat>& raw, bool header_only,
                  const RunOptions& run);

/// Prints camera, frames, rate, gaps, settings and condition of a recording. \throws InputError if
/// it is damaged (after printing), DeviceError, Interrupted.
void info_recording(const std::string& file, const RunOptions& run);

/// `stipple info` of the folder of a rig. Reads all streams. \throws InputError as open_rig_folder,
/// or if a stream is damaged.
void info_rig(const std::string& folder, const RunOptions& run);

/// `stipple info` of the file of a rig, or of a name in `stipple list rigs`. \throws InputError as
/// read_rig.
void info_rig_file(const std::string& name, const RunOptions& run);

/// What `name` is, if it is a sensor, a schedule, a rig, a space of `stipple explore` or a scene: a
/// file of settings by its keys, a compiled schedule (.mem, .hex) by its extension, else a name of
/// config/ or of a scene.
enum class SettingsKind { kNone, kSensor, kSchedule, kScene, kRig, kSpace };

/// \throws InputError for a name that both a sensor and a schedule have, and for a .toml file whose
/// keys are of none of them.
[[nodiscard]] SettingsKind settings_kind(const std::string& name);

/// `stipple info` of one of them. \throws InputError as its reader.
void info_settings(SettingsKind kind, const std::string& name, const RunOptions& run);

/// `stipple info` of a space of `stipple explore`, a file or a name of config/spaces. \throws
/// InputError as parse_space.
void info_space(const std::string& name, const RunOptions& run);

/// What a file that nothing knows seems to be, by its first bytes: "an empty file", "a web page
/// (HTML)", `text that begins "..."`, "a file that begins with the bytes 89 41 42".
/// \throws InputError if the file cannot be read.
[[nodiscard]] std::string sniff_file_type(const std::string& file);

}  // namespace stipple
