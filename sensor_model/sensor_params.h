#pragma once

#include <cstdint>
#include <string>

namespace stipple {

/// How the converter maps a level between two digital numbers.
enum class AdcRounding : std::uint8_t { kNearest, kFloor };

/// Closed interval of accepted values of a parameter.
struct ParameterRange {
    double least;
    double most;
};

/// The sensor of the paper's Eq. 1 (docs/sensor_model.md): shot noise, full well, read noise and
/// converter of an array of equal pixels. Photons and electrons are the same thing here: the
/// quantum efficiency is in `photons_per_unit`.
///
/// Not modelled: dark current, fixed pattern, defects, row and column noise, crosstalk, blooming,
/// non-linearity, black level.
struct SensorParams {
    std::string name = "paper";
    double photons_per_unit = 1000;  ///< r: mean electrons per slot at flux 1.0
    double full_scale_e = 2000;      ///< s: electrons mapped to the highest DN
    double full_well_e = 20000;      ///< w: charge beyond it is lost
    double read_noise_e = 10;        ///< sigma: standard deviation of each reading
    bool shot_noise = true;          ///< false: the charge is its mean, not a Poisson draw
    int bit_depth = 8;               ///< d: the highest DN is 2^d - 1
    AdcRounding rounding = AdcRounding::kNearest;
    double slot_us = 5000;  ///< time slot: one frame of the footage
    int charge_stores = 1;  ///< of a pixel: exposures that can be under way at once

    static constexpr ParameterRange kPhotonsPerUnit{1e-3, 1e7};
    static constexpr ParameterRange kFullScaleE{1, 1e7};
    static constexpr ParameterRange kFullWellE{1, 1e7};  ///< below 2^24: exact in float
    static constexpr ParameterRange kReadNoiseE{0, 1e5};
    static constexpr ParameterRange kBitDepth{1, 16};
    static constexpr ParameterRange kSlotUs{1e-3, 1e9};
    static constexpr ParameterRange kChargeStores{1, 2};

    bool operator==(const SensorParams&) const = default;
};

/// \throws InputError naming the sensor, the parameter and its range, for the first parameter
/// outside its range or not a number.
void validate(const SensorParams& params);

}  // namespace stipple
