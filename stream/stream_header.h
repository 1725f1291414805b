#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "core/rounding.h"

namespace stipple {

/// What is peculiar to a pixel of a calibration tile, relative to the whole sensor's numbers.
struct CalibrationPixel {
    double responsivity = 1;     ///< of `electrons_per_unit`: a neutral-density mosaic
    double conversion_gain = 1;  ///< DN per electron, relative to 1 / `gain_e_per_dn`: dual gain

    bool operator==(const CalibrationPixel&) const = default;
};

/// A tile that is repeated over the array from pixel (0, 0); by default there is none.
struct CalibrationTile {
    int rows = 0;
    int cols = 0;
    std::vector<CalibrationPixel> pixels;  ///< by row and column

    bool operator==(const CalibrationTile&) const = default;
};

/// The parameters that convert DN to electrons, and their noise. Terms of EMVA 1288. The ranges are
/// in docs/stream_format.md.
struct Calibration {
    int bit_depth = 8;  ///< 1..16
    Rounding rounding = Rounding::kNearest;
    double black_level_dn = 0;  ///< mean DN without charge
    double gain_e_per_dn = 2000.0 / 255;
    double read_noise_e = 10;  ///< standard deviation
    double full_well_e = 20000;
    double electrons_per_unit = 1000;  ///< electrons that flux 1.0 collects in one slot
    double dark_e_per_slot = 0;        ///< electrons that an open slot without light collects
    CalibrationTile tile = {};

    bool operator==(const Calibration&) const = default;
};

/// The most that a stream holds (docs/stream_format.md): exposures of a tile and of the array of a
/// random schedule, bytes of a schedule's name.
inline constexpr std::size_t kMaxTileExposures = std::size_t{1} << 24U;
inline constexpr std::size_t kMaxRandomExposures = std::size_t{1} << 25U;
inline constexpr std::size_t kMaxNameBytes = 64;

/// The schedule as it is stored: its own list of exposures, or the generator `random_schedule`
/// with a seed (for tiles as large as the array, where a list would weigh more than the samples).
struct ScheduleSource {
    enum class Kind : std::uint8_t { kExplicit = 0, kRandom = 1 };
    Kind kind = Kind::kExplicit;
    std::vector<int> exposure_slots;  ///< kRandom only
    std::uint64_t seed = 0;           ///< kRandom only
    bool operator==(const ScheduleSource&) const = default;
};

/// The header of a stream.
struct StreamHeader {
    FrameShape shape;
    double slot_us = 5000;
    Calibration calibration;
    ExposureSchedule schedule;
    ScheduleSource schedule_source;
    std::string schedule_name;  ///< informative, at most 64 bytes of UTF-8
    std::string provenance;     ///< TOML text: emulator parameters, seed, footage; may be empty
    ColourFilter cfa = ColourFilter::kNone;  ///< of the one plane, if it is a mosaic

    bool operator==(const StreamHeader&) const = default;
};

}  // namespace stipple
