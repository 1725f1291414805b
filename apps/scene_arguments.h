#pragma once

#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace stipple {

/// `--frames`, `--size` and `--seed` of an embedded scene. `options` must outlive the parsing.
void add_scene_arguments(CLI::App& command, SceneOptions& options);

}  // namespace stipple
