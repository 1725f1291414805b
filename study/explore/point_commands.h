#pragma once

#include <string>

#include "study/explore/space.h"
#include "io/footage_reader.h"

namespace stipple {

/// The clip of a trial.
struct PointClip {
    int slots;
    ComparedSlots compared;       ///< of these; empty: not known
    bool is_whole;                ///< the footage has no more slots
    FootageOptions reading = {};  ///< of the footage
    int seeds = 1;                ///< trials of the point
};

/// A point as a space of its own, TOML.
[[nodiscard]] std::string point_space(const Space& space, const SpacePoint& point,
                                      const PointClip& clip);

/// Lines of a shell that repeat a trial in an empty folder: `explore` with `point_space` and, where
/// the footage is as long as the trial and other commands can do it, each step. Paths of files stay
/// as they are.
[[nodiscard]] std::string point_commands(const Space& space, const SpacePoint& point,
                                         const PointClip& clip);

}  // namespace stipple
