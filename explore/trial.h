#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/flux_video.h"
#include "decoder/decode_options.h"
#include "explore/point_view.h"
#include "explore/space.h"
#include "explore/trial_figures.h"
#include "io/png_file.h"
#include "metrics/video_quality.h"
#include "readout/footage_origin.h"
#include "readout/rig.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Light is compared up to this one: full_scale_e / photons_per_unit of the default sensor.
inline constexpr double kBrightestLight = 2;

/// How the video of the demo is compared with the truth: without the first and last 4 of its frames
/// (fewer of short clips), light up to kBrightestLight.
[[nodiscard]] QualityOptions trial_quality(int slots);

/// Asked now and then during long work; false: end it.
using KeepGoing = std::function<bool()>;

/// Thrown where a KeepGoing has said so.
struct TrialStopped {};

/// Light of the trials of a space.
struct TrialLight {
    FluxVideo video;
    FootageOrigin origin;
    bool is_whole = true;                ///< false: the footage has more slots
    std::vector<Message> warnings = {};  ///< of the reader
};

/// Whether `footage` names an embedded scene.
[[nodiscard]] bool is_scene(const std::string& footage);

/// The first slots of an embedded scene, or of a file. \throws InputError, also for a scene with
/// options of reading, TrialStopped.
[[nodiscard]] TrialLight read_light(const Space& space, const std::string& footage,
                                    const FootageOptions& reading, const KeepGoing& keep_going);

/// A window and how it is read.
struct TimedWindow {
    std::optional<ReadoutTiming> timing;  ///< none: the sensor has no clocks
    NamedSchedule schedule;
    FrameShape shape;
    std::string keys = {};  ///< of the sensor that `readout.sensor` names, as lines of TOML
};

/// A point of a space, set up.
struct Trial {
    Rig rig;                           ///< of one sensor, unless the point names a rig
    std::vector<SensorSetup> setups;   ///< of its sensors
    std::vector<TimedWindow> windows;  ///< whose rate, bandwidth and energy are computed
    PointView view;                    ///< what the sensors read
    DecodeOptions decoding;
    int slots;               ///< the first ones of the light are recorded
    ComparedSlots compared;  ///< of these
    std::string identity;    ///< all that determines the result; equal for equal trials
};

/// Precondition: slots > 0, more than the light has are not recorded; `compared` is of these.
/// \throws InputError naming file, line and key of a value that cannot be used.
[[nodiscard]] Trial set_up_trial(const Space& space, const SpacePoint& point,
                                 const TrialLight& light, int slots, ComparedSlots compared);

struct TrialOutcome {
    TrialFigures figures;
    PngPixels picture;  ///< the middle slot (TrialPicture)
};

/// Records the light as `stream`, those of further sensors beside it, decodes them to one video,
/// and removes them. `progress` receives the part of the slots that is decoded, 0..1. \throws
/// InputError, DeviceError, TrialStopped.
[[nodiscard]] TrialOutcome run_trial(
    const Trial& trial, const TrialLight& light, const std::filesystem::path& stream,
    const KeepGoing& keep_going, const std::function<void(double)>& progress = [](double) {});

}  // namespace stipple
