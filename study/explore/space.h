#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "study/decoders/own_decoder.h"

namespace stipple {

/// Axes of what a sensor reads of its array (point_view.h); each is there only if a point has it.
inline constexpr std::array kViewAxes{"binning", "binning_mode", "window_rows"};

/// The values that one property of a trial takes.
struct SpaceAxis {
    std::string name;  ///< "sensor", "schedule", "rig", "footage", "method", "seed", "system",
                       ///< "binning", "binning_mode", "window_rows", or a key of --set
    std::vector<std::string> values;
};

/// A choice of one value of each axis, in their order. An empty value stands for the default.
using SpacePoint = std::vector<std::string>;

/// Values that belong together, such as a schedule or a rig, the keys that it needs, and a method.
struct SpaceSystem {
    std::string name;                                         ///< value of the axis "system"
    std::vector<std::pair<std::string, std::string>> values;  ///< axis and value
    std::string copy_of = {};  ///< name of the system that Space::set_methods has copied
};

/// Slots from `begin` on, before `end`.
struct ComparedSlots {
    int begin = 0;
    int end = 0;

    bool operator==(const ComparedSlots&) const = default;
};

/// All trials of `stipple explore`: each value of each axis with each of the others
/// (docs/explore.md).
struct Space {
    static constexpr std::uint64_t kMaxPoints = 100'000;

    /// footage, sensor, schedule, rig (if a point has one), method, seed, binning and the like (if
    /// a point has it), system, the keys.
    std::vector<SpaceAxis> axes;
    /// If any, they set schedule or rig, method and some of the keys.
    std::vector<SpaceSystem> systems;
    int frames = 32;              ///< slots of each trial, at most
    ComparedSlots compared = {};  ///< slots that are compared; empty: as compared_slots finds
    FrameShape scene{.rows = 48, .cols = 64, .planes = 1};  ///< of embedded scenes
    /// The window whose readout is timed; 0: that of the clip.
    FrameShape readout{.rows = 0, .cols = 0, .planes = 1};
    std::string readout_sensor;  ///< the sensor whose clocks time it; empty: that of the point
    std::vector<OwnDecoder> decoders = {};  ///< methods that are not those of Stipple

    /// Gives an axis other values; one that systems set, the first of them in each that does.
    /// Copies of the systems that are named stay too.
    /// \throws InputError if there is none of this name, or no system of a name.
    void replace(const SpaceAxis& axis);
    /// Decodes by these methods: they become the values of the axis "method". If systems set it,
    /// each system of one sensor with the method `best` has a copy for each of them, without keys
    /// of `decoder`; the copy of "coded best" by "own" is "coded own".
    void set_methods(const std::vector<std::string>& methods);
    [[nodiscard]] std::uint64_t size() const;
    /// Point `number` of size(); the last axis changes fastest.
    [[nodiscard]] SpacePoint point(std::uint64_t number) const;
    /// The index of the axis `name`; the number of axes if there is none.
    [[nodiscard]] std::size_t axis(std::string_view name) const;
    /// The value of the axis `name`, which there is.
    [[nodiscard]] const std::string& value(const SpacePoint& point, std::string_view name) const {
        return point[axis(name)];
    }
    /// The decoder of a point; null: a method of Stipple.
    [[nodiscard]] const OwnDecoder* own_decoder(const SpacePoint& point) const;
    /// The rig of a point; empty: it has one sensor.
    [[nodiscard]] std::string rig(const SpacePoint& point) const;
    /// The keys of `section` that a point sets, as "KEY=VALUE".
    [[nodiscard]] std::vector<std::string> settings(const SpacePoint& point,
                                                    std::string_view section) const;
};

/// The space that a TOML text describes; messages call it `name`. \throws InputError naming the
/// fault: no TOML, no sensor, an unknown key, a value of a wrong type, or more than kMaxPoints
/// points.
[[nodiscard]] Space parse_space(const std::string& text, const std::string& name);

}  // namespace stipple
