#pragma once

#include "apps/command_line.h"
#include "scenes/scene.h"

namespace stipple {

/// `--frames`, `--size` and `--seed` of an embedded scene. `options` must outlive the parsing.
void add_scene_arguments(Command& command, SceneOptions& options);

}  // namespace stipple
