#pragma once

#include <cstdint>
#include <string>

#include "core/exposure_schedule.h"
#include "core/geometry.h"

namespace stipple {

/// How the converter maps a level between two digital numbers (DN).
enum class Rounding : std::uint8_t { kNearest = 0, kFloor = 1 };

/// What a decoder needs to turn DN into electrons and to know how far to trust them.
/// Terms as in EMVA 1288.
struct Calibration {
    int bit_depth = 8;  ///< 1..16
    Rounding rounding = Rounding::kNearest;
    double black_level_dn = 0;  ///< DN of no charge
    double gain_e_per_dn = 2000.0 / 255;
    double read_noise_e = 10;  ///< standard deviation
    double full_well_e = 20000;
    double electrons_per_unit = 1000;  ///< electrons that flux 1.0 collects in one slot

    bool operator==(const Calibration&) const = default;
};

/// The schedule as it is stored: its own list of exposures, or the generator `random_schedule`
/// with a seed (for tiles as large as the array, where a list would weigh more than the samples).
struct ScheduleSource {
    enum class Kind : std::uint8_t { kExplicit = 0, kRandom = 1 };
    Kind kind = Kind::kExplicit;
    std::vector<int> exposure_slots;  ///< kRandom only
    std::uint64_t seed = 0;           ///< kRandom only
    bool operator==(const ScheduleSource&) const = default;
};

/// Everything a stream says of itself before the first sample.
struct StreamHeader {
    FrameShape shape;
    double slot_us = 5000;
    Calibration calibration;
    ExposureSchedule schedule;
    ScheduleSource schedule_source;
    std::string schedule_name;  ///< for people, at most 64 bytes of UTF-8
    std::string provenance;     ///< TOML text: emulator parameters, seed, footage; may be empty

    bool operator==(const StreamHeader&) const = default;
};

}  // namespace stipple
