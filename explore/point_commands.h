#pragma once

#include <string>

#include "explore/space.h"

namespace stipple {

/// A point as a space of its own, TOML. `slots`: of the clip.
[[nodiscard]] std::string point_space(const Space& space, const SpacePoint& point, int slots);

/// Lines of a shell that repeat a trial in an empty folder: `explore` with `point_space` and, where
/// the footage is as long as the trial (`is_whole`), each step. Paths of files stay as they are.
[[nodiscard]] std::string point_commands(const Space& space, const SpacePoint& point, int slots,
                                         bool is_whole);

}  // namespace stipple
