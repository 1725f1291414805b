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

/// Calibration of a pixel relative to that of the sensor.
struct CalibrationPixel {
    double responsivity = 1;     ///< factor of `electrons_per_unit`: neutral-density filters
    double conversion_gain = 1;  ///< factor of 1 / `gain_e_per_dn`: pixels of dual gain

    bool operator==(const CalibrationPixel&) const = default;
};

/// Calibration of single pixels: a tile that repeats over the array from pixel (0, 0). Empty if all
/// pixels are equal.
struct CalibrationTile {
    int rows = 0;
    int cols = 0;
    std::vector<CalibrationPixel> pixels;  ///< order (row, col); rows x cols of them

    bool operator==(const CalibrationTile&) const = default;
};

/// Parameters that convert DN to electrons and to light, with the noise of a sample, in the terms
/// of EMVA 1288. docs/stream_format.md has the formula and the ranges.
struct Calibration {
    int bit_depth = 8;  ///< 1..16
    Rounding rounding = Rounding::kNearest;
    double black_level_dn = 0;            ///< mean DN without charge
    double gain_e_per_dn = 2000.0 / 255;  ///< electrons per DN: the inverse of K of EMVA 1288
    double read_noise_e = 10;             ///< standard deviation of a readout, in electrons
    double full_well_e = 20000;           ///< max electrons of a pixel
    double electrons_per_unit = 1000;     ///< electrons that flux 1.0 gives in one slot
    double dark_e_per_slot = 0;           ///< dark signal of an open slot, in electrons
    CalibrationTile tile = {};
    /// The samples are exact but for rounding, as those of a simulation: decoders need not smooth.
    bool noise_free = false;

    bool operator==(const Calibration&) const = default;
};

/// A calibration of one site (a pixel in one plane), in the terms of docs/calibration.md, with the
/// variances of the estimates.
struct SiteCalibration {
    float gain = 1;           ///< factor of `Calibration::electrons_per_unit`
    float gain_variance = 0;  ///< of `gain`
    float offset_dn = 0;      ///< mean DN without light and dark current: the site's black level
    float offset_variance_dn2 = 0;
    float dark_dn_per_s = 0;      ///< dark current of an open slot; slightly negative if unknown
    float dark_variance = 0;      ///< of `dark_dn_per_s`
    float readout_noise_dn2 = 0;  ///< temporal variance without light, rounding included
    bool defect = false;          ///< its samples say nothing of the light

    bool operator==(const SiteCalibration&) const = default;
};

/// The non-linear response of a chip as a table: to each DN the one that a linear chip would give,
/// with the slope of the chip in the dark (docs/calibration.md).
struct ResponseTable {
    std::vector<float> linear_dn;  ///< of each DN, 2^bit depth, strictly rising; empty: linear
    std::vector<float> variance_dn2 = {};  ///< of these, as they are estimates; as many

    bool operator==(const ResponseTable&) const = default;
};

/// Limits of the format (docs/stream_format.md): exposures of a tile, exposures of the array of a
/// random schedule, bytes of the name of a schedule.
inline constexpr std::size_t kMaxTileExposures = std::size_t{1} << 24U;
inline constexpr std::size_t kMaxRandomExposures = std::size_t{1} << 25U;
inline constexpr std::size_t kMaxNameBytes = 64;

/// Form in which a header stores its schedule: the list of exposures, or the arguments of
/// `random_schedule`, whose tile is the array, so that the list would be larger than the samples.
struct ScheduleSource {
    enum class Kind : std::uint8_t { kExplicit = 0, kRandom = 1 };
    Kind kind = Kind::kExplicit;
    std::vector<int> exposure_slots;  ///< kRandom only: lengths of the exposures, 1..64 slots
    std::uint64_t seed = 0;           ///< kRandom only
    bool operator==(const ScheduleSource&) const = default;
};

/// The values of a calibration that a switch changes.
struct ReadoutValues {
    Rounding rounding = Rounding::kNearest;
    double black_level_dn = 0;
    double gain_e_per_dn = 1;
    double read_noise_e = 0;
    double full_well_e = 1;
    double electrons_per_unit = 1;

    bool operator==(const ReadoutValues&) const = default;
};

/// From a slot on a stream has another schedule and other values of its readouts (core/
/// schedule_parts.h). The first slot may be in an exposure that began before it.
struct ScheduleSwitch {
    std::int64_t slot = 1;
    ExposureSchedule schedule;
    ScheduleSource source;
    std::string name;  ///< of the schedule
    ReadoutValues values;
    std::uint16_t number = 1;  ///< of this switch, from 1 on; one that is missing was damaged
    /// Max span of the exposures under way at the switch and those of its schedule; 0 if unknown.
    int longest_span_slots = 0;

    bool operator==(const ScheduleSwitch&) const = default;
};

/// Header of a sample stream (docs/stream_format.md): everything that its decoder knows of the
/// sensor.
struct StreamHeader {
    FrameShape shape;       ///< of the array
    double slot_us = 5000;  ///< length of a slot
    Calibration calibration;
    ExposureSchedule schedule;
    ScheduleSource schedule_source;
    std::string schedule_name;  ///< informative, at most 64 bytes of UTF-8
    std::string provenance;     ///< TOML text: emulator parameters, seed, footage; may be empty
    ColourFilter cfa = ColourFilter::kNone;  ///< of the one plane, if it is a mosaic
    /// Calibration of each site of the array, order (plane, row, col); empty: none. Not part of a
    /// stream: a reader is told it.
    std::vector<SiteCalibration> sites = {};
    /// Likewise; offset, dark current and noise of `sites` are in linear DN. Empty without `sites`.
    ResponseTable response = {};
    bool may_switch = false;  ///< version 4: the schedule may change
    /// By slot: those that a reader has met before the packet that it read last. Not part of a
    /// header.
    std::vector<ScheduleSwitch> switches = {};

    bool operator==(const StreamHeader&) const = default;
};

}  // namespace stipple
