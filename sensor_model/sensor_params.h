#pragma once

#include <cstdint>
#include <string>

#include "core/rounding.h"
#include "sensor_model/physical_terms.h"

namespace stipple {

/// Terms of the sensor model: those of Eq. 1 of the paper only, or those of EMVA 1288 too.
enum class SensorMode : std::uint8_t { kPaper, kPhysical };

/// Parameters of a sensor, with the symbols of Eq. 1 (Portz, Zhang, Jiang, ICCP 2013;
/// docs/sensor_model.md). `visit_sensor_keys` has their ranges. In paper mode all pixels are equal,
/// a photon gives one electron, and `physical` has its defaults. In physical mode all terms count.
///
/// Not modelled: see PhysicalTerms.
struct SensorParams {
    std::string name = "paper";
    double photons_per_unit = 1000;  ///< r: mean photons per site and slot at flux 1.0
    double full_scale_e = 2000;      ///< s: electrons of the highest DN
    double full_well_e = 20000;      ///< w: max electrons of a pixel; charge beyond it is lost
    double read_noise_e = 10;        ///< sigma: standard deviation of a readout, in electrons
    bool shot_noise = true;          ///< false: the charge is its mean, not a Poisson draw
    int bit_depth = 8;               ///< d: the highest DN is 2^d - 1
    Rounding rounding = Rounding::kNearest;
    double slot_us = 5000;  ///< length of a slot
    int charge_stores = 1;  ///< of a pixel: max exposures under way at once, 1 or 2
    SensorMode mode = SensorMode::kPaper;
    PhysicalTerms physical = {};

    /// Electrons per DN, s / (2^d - 1): the inverse of the system gain K of EMVA 1288.
    [[nodiscard]] double gain_e_per_dn() const { return full_scale_e / ((1 << bit_depth) - 1); }
    /// Mean electrons that flux 1.0 collects in one slot.
    [[nodiscard]] double electrons_per_unit() const {
        return photons_per_unit * physical.quantum_efficiency;
    }
    /// Mean dark signal of one open slot, in electrons; without hot pixels.
    [[nodiscard]] double dark_e_per_slot() const;
    /// Mean dark signal, in electrons, of a storage node that waits `storage_wait_us`; the mean
    /// over the rows is half of it.
    [[nodiscard]] double storage_dark_e() const;
    /// Mean electrons of light at which a pixel without defects reaches the full well or the
    /// highest DN.
    [[nodiscard]] double saturation_e() const;
    /// Standard deviation of the temporal noise of a readout, in electrons: read, reset, row noise
    /// (root mean square over the taps), column noise and the mean dark signal of the storage node;
    /// of dual-gain pixels at high gain.
    [[nodiscard]] double temporal_read_noise_e() const;

    bool operator==(const SensorParams&) const = default;
};

/// \throws InputError naming the sensor, the parameter and its range, for the first parameter
/// outside its range or not a number, and for terms of the physical mode in paper mode.
void validate(const SensorParams& params);

}  // namespace stipple
