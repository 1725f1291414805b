#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "apps/arguments/command_line.h"
#include "capture/recording/read_ahead.h"

namespace stipple {

struct SceneOptions;

/// `--transfer` and `--raw`, of the footage that its help names, and `--luminance`.
void add_footage_arguments(Command& command, FootageOptions& options,
                           const std::string& footage = "the footage");

/// `--raw` alone.
void add_raw_argument(Command& command, std::optional<RawFormat>& raw, const std::string& footage);

/// `--max-value V`: positive and finite.
void add_max_value(Command& command, std::optional<double>& max_value);

/// How the frames of footage become slots.
struct ResampleChoice {
    std::string method;  ///< hold, blend, flow; empty: each frame is a slot
};

/// `--resample`, `--frames-hz` and `--scale`.
void add_resample_arguments(Command& command, ResampleChoice& choice, FootageOptions& options);

/// Slots of the sensor one after the other, empty at the end.
struct SlotSource {
    std::function<std::span<const float>()> next;
    std::optional<int> slots;  ///< if the footage tells
};

/// The slots of `footage`, which must outlive them. \throws InputError naming `source` if its frame
/// rate is necessary but unknown, or if it is a mosaic that flow would mix.
[[nodiscard]] SlotSource slots_of(ReadAhead& footage, const std::string& source,
                                  const ResampleChoice& choice, const FootageOptions& options,
                                  double slot_us);

/// Footage or a recording. What its reader warns of goes to standard error. \throws InputError as
/// ReadAhead.
[[nodiscard]] ReadAhead read_footage(const std::string& source, const FootageOptions& options);

/// `--frames`, `--size` and `--seed` of an embedded scene. `options` must outlive the parsing.
void add_scene_arguments(Command& command, SceneOptions& options);

}  // namespace stipple
