#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/homography.h"
#include "readout/sensor_file.h"

namespace stipple {

class Config;
struct SensorSetup;

/// A sensor of a rig.
struct RigSensor {
    std::string name;                ///< of its stream too: NAME.stipple
    SensorChoice choice;             ///< without the share
    double share = 1;                ///< of the light of the aperture
    Homography from_reference = {};  ///< places of the first sensor to those of this one
    std::int64_t phase_slots = 0;    ///< slots of the footage before its slot 0
    std::string sha256 = {};         ///< of its stream; empty: not told

    [[nodiscard]] std::string file() const { return name + ".stipple"; }
};

/// Whether the sensors share the light of one aperture, or have one each.
enum class RigAperture : std::uint8_t { kShared, kOwn };

/// Sensors that see one scene from one place (docs/rig.md). The first one is the reference: it has
/// neither offset nor phase.
struct Rig {
    static constexpr int kMaxSensors = 16;

    std::string name;
    RigAperture aperture = RigAperture::kShared;
    std::vector<RigSensor> sensors;
};

/// Reads the keys of docs/rig.md; `sensor` is the default of their key `sensor`. \throws InputError
/// naming file, line and key: two sensors of one name, shares of one aperture with a sum above 1, a
/// singular homography, a first sensor that is moved, an unknown key, a value of a wrong type.
[[nodiscard]] Rig read_rig(Config& config, const std::string& sensor = SensorChoice().sensor);

/// The file of a rig in the folder of its streams.
inline constexpr const char* kRigFile = "rig.toml";

/// The sensors of a rig for footage of this shape; `filter` is that of a mosaic. A share s is the
/// setting photons_per_unit = s r, so that each stream has the units of the scene, and is the one
/// that "stipple emulate" makes with this setting. \throws InputError as set_up_sensor; if sensors
/// have another `slot_us` or other decoded planes than the first one; if one sees none of the
/// pixels of the first, or maps one to infinity; if a mosaic would be moved.
[[nodiscard]] std::vector<SensorSetup> set_up_rig(const Rig& rig, FrameShape footage,
                                                  ColourFilter filter = ColourFilter::kNone);

}  // namespace stipple
