#pragma once

#include <string>

#include "core/flux_video.h"
#include "core/geometry.h"
#include "readout/rig.h"
#include "sensor_model/binning.h"
#include "study/explore/space.h"

namespace stipple {

/// What the sensor of a point reads of the array: all pixels, sums of binning x binning of them, or
/// a window of rows in the middle.
struct PointView {
    int binning = 1;
    BinningMode mode = BinningMode::kVoltage;
    double rows = 1;  ///< fraction of them

    /// The window of an array of this shape.
    [[nodiscard]] FrameShape window(FrameShape array) const;
    /// Its pixels after binning.
    [[nodiscard]] FrameShape binned(FrameShape window) const;
    [[nodiscard]] bool is_whole() const { return binning == 1 && rows == 1; }
};

/// Whether a point has a key of its view; the value may be wrong.
[[nodiscard]] bool has_view(const Space& space, const SpacePoint& point);

/// \throws InputError for a value that is none, and for binning with a rig.
[[nodiscard]] PointView view_of(const Space& space, const SpacePoint& point);

/// The light of the window; what is decoded is compared with it.
[[nodiscard]] FluxVideo window_light(const FluxVideo& light, const PointView& view);

/// The mean light of the binned pixels of the window. \throws InputError if it has no whole number
/// of them.
[[nodiscard]] FluxVideo binned_light(const FluxVideo& window, const PointView& view);

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
