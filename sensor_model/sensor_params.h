#pragma once

#include <cstdint>
#include <string>

#include "core/rounding.h"
#include "sensor_model/physical_terms.h"

namespace stipple {

/// Which terms the model has: those of Eq. 1, or those of EMVA 1288 as well.
enum class SensorMode : std::uint8_t { kPaper, kPhysical };

/// A sensor (docs/sensor_model.md). In paper mode Eq. 1: shot noise, full well, read noise and
/// converter of an array of equal pixels, where photons and electrons are the same thing and
/// `physical` stays at its defaults. In physical mode all terms count.
///
/// Not modelled: see PhysicalTerms.
struct SensorParams {
    std::string name = "paper";
    double photons_per_unit = 1000;  ///< r: mean photons per slot at flux 1.0
    double full_scale_e = 2000;      ///< s: electrons of 2^d - 1 DN
    double full_well_e = 20000;      ///< w: charge beyond it is lost; below 2^24, exact in float
    double read_noise_e = 10;        ///< sigma: rms of each reading's noise
    bool shot_noise = true;          ///< false: the charge is its mean, not a Poisson draw
    int bit_depth = 8;               ///< d: the highest DN is 2^d - 1
    Rounding rounding = Rounding::kNearest;
    double slot_us = 5000;  ///< time slot: one frame of the footage
    int charge_stores = 1;  ///< per pixel: max simultaneous exposures
    SensorMode mode = SensorMode::kPaper;
    PhysicalTerms physical = {};

    /// K: electrons that raise the output by one DN.
    [[nodiscard]] double gain_e_per_dn() const { return full_scale_e / ((1 << bit_depth) - 1); }
    /// Mean electrons that flux 1.0 collects in one slot.
    [[nodiscard]] double electrons_per_unit() const {
        return photons_per_unit * physical.quantum_efficiency;
    }
    /// Mean dark electrons of an ordinary pixel in one open slot.
    [[nodiscard]] double dark_e_per_slot() const;
    /// Mean electrons of light that fill the well or the converter of an ordinary pixel.
    [[nodiscard]] double saturation_e() const;
    /// Temporal noise of one reading, standard deviation: read, reset and row noise (rms of taps).
    [[nodiscard]] double temporal_read_noise_e() const;

    bool operator==(const SensorParams&) const = default;
};

/// \throws InputError naming the sensor, the parameter and its range, for the first parameter
/// outside its range or not a number, and for terms of the physical mode in paper mode.
void validate(const SensorParams& params);

}  // namespace stipple
