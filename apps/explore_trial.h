#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/arguments/run_options.h"
#include "apps/explore_space.h"
#include "core/flux_video.h"
#include "decoder/decode_options.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Light of the trials of a space.
struct TrialLight {
    FluxVideo video;
    FootageOrigin origin;
};

/// The first slots of an embedded scene, or of a file. \throws InputError, Interrupted.
[[nodiscard]] TrialLight read_light(const Space& space, const std::string& footage);

/// A point of a space, set up.
struct Trial {
    SensorSetup setup;
    NamedSchedule timed;  ///< schedule of the window that is timed
    FrameShape window;    ///< this window
    DecodeOptions decoding;
    std::string identity;  ///< all that determines the result; equal for equal trials
};

/// \throws InputError naming file, line and key of a value that cannot be used.
[[nodiscard]] Trial set_up_trial(const Space& space, const SpacePoint& point,
                                 const TrialLight& light);

/// Records the light as `stream`, which is removed in the end, decodes it, and gives the figures of
/// docs/explore.md. \throws InputError, DeviceError, Interrupted.
[[nodiscard]] nlohmann::ordered_json run_trial(const Trial& trial, const TrialLight& light,
                                               const std::filesystem::path& stream);

}  // namespace stipple
