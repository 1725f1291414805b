#pragma once

#include <optional>
#include <string>

#include "apps/arguments/command_line.h"
#include "capture/recording/read_ahead.h"
#include "io/frame_resampler.h"

namespace stipple {

struct SceneOptions;

/// `--transfer`, `--raw` and `--min-value`, of the footage that its help names, and `--luminance`.
void add_footage_arguments(Command& command, FootageOptions& options,
                           const std::string& footage = "the footage");

/// `--raw` alone.
void add_raw_argument(Command& command, std::optional<RawFormat>& raw, const std::string& footage);

/// `--max-value V`: positive and finite.
void add_max_value(Command& command, std::optional<double>& max_value);

/// `--frames`, `--crop`, `--bin`, `--resize` and `--scale`.
void add_part_arguments(Command& command, FootageOptions& options);

/// `--resample` and `--frames-hz`.
void add_resample_arguments(Command& command, std::optional<Resampling>& method,
                            FootageOptions& options);

/// Footage or a recording. What its reader warns of goes to standard error. \throws InputError as
/// ReadAhead.
[[nodiscard]] ReadAhead read_footage(const std::string& source, const FootageOptions& options);

/// `--frames`, `--size` and `--seed` of an embedded scene. `options` must outlive the parsing.
void add_scene_arguments(Command& command, SceneOptions& options);

}  // namespace stipple
