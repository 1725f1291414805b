#pragma once

#include <string>

#include "explore/space.h"
#include "readout/rig.h"

namespace stipple {

/// The sensors of a point of a space.
struct PointRig {
    Rig rig;           ///< of one sensor if the point names a schedule
    std::string keys;  ///< of the file of the rig, as lines of TOML; empty: it has no file
};

/// Keys of the section `sensor` change all sensors of a rig, and the seed s adds kMaxSensors (s -
/// 1) to theirs. \throws InputError as read_rig; if a sensor of the rig is another one than that of
/// the point; for keys of a schedule with a rig, and keys of a rig without one.
[[nodiscard]] PointRig rig_of(const Space& space, const SpacePoint& point);

}  // namespace stipple
