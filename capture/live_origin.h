#pragma once

#include <functional>
#include <string>

#include "capture/live_camera.h"
#include "readout/provenance.h"

namespace stipple {

/// What the stream of a camera says of where its light comes from: no address, no time. A replay
/// has the origin of its file. `check` as in origin_of. \throws InputError as origin_of.
[[nodiscard]] FootageOrigin live_origin(const std::string& address, const LiveCamera& camera,
                                        double black_level_dn, const std::function<void()>& check);

}  // namespace stipple
