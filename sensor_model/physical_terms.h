#pragma once

#include <cstdint>
#include <vector>

#include "core/colour_filter.h"

namespace stipple {

/// The terms that physical mode adds to Eq. 1 (EMVA 1288). docs/physics.md has the formulas and,
/// for each term, the effects that are not modelled. The defaults add nothing.
///
/// Not modelled: spectra, kTC noise other than `reset_noise_e`, noise of the ADC, aging, and the
/// temperature of all terms but the dark current.
struct PhysicalTerms {
    double quantum_efficiency = 1;            ///< electrons per photon
    double dark_current_e_per_s = 0;          ///< at `dark_reference_c`
    double dark_reference_c = 20;             ///< degrees Celsius
    double temperature_c = 20;                ///< degrees Celsius
    double dark_doubling_c = 8;               ///< kelvins that double the dark current
    double temperature_drift_c_per_s = 0;     ///< rise of `temperature_c` since slot 0
    double storage_dark_current_e_per_s = 0;  ///< of charge that waits, at `dark_reference_c`
    double storage_wait_us = 0;               ///< of the whole scan; a row waits row / rows of it
    double dsnu_e = 0;                        ///< standard deviation of the pixel offsets
    double prnu = 0;                          ///< standard deviation of relative responsivity
    double read_noise_spread = 0;             ///< relative spread of `read_noise_e` over the pixels
    double reset_noise_e = 0;                 ///< standard deviation, each exposure
    std::vector<double> row_noise_e = {};     ///< temporal, per row and slot; one value per tap
    double column_noise_e = 0;                ///< standard deviation of the fixed column offsets
    double column_temporal_noise_e = 0;       ///< standard deviation, per column and slot
    double black_level_dn = 0;                ///< mean DN without charge
    double inl_dn = 0;                        ///< peak of the integral non-linearity of the ADC
    double dnl_dn = 0;                        ///< max error of a code width of the ADC
    double hot_pixel_fraction = 0;            ///< of all pixels
    double hot_pixel_dark_current = 0;        ///< additional electrons/s at `dark_reference_c`
    double dead_pixel_fraction = 0;           ///< of all pixels; these collect nothing
    double crosstalk = 0;  ///< fraction of light that reaches the four neighbours
    double blooming = 0;   ///< fraction of overflow that reaches them
    double lag = 0;        ///< fraction of charge that stays for the next exposure
    double parasitic_light_sensitivity = 0;  ///< fraction of light that a closed store collects
    double row_skew_slots = 0;               ///< delay of the last row behind the first
    double response_loss = 0;                ///< relative, at the full well (non-linearity)
    double low_gain_read_noise_e = 0;        ///< of readings above `dual_gain_limit_e`
    double dual_gain_limit_e = 0;            ///< charge up to which high gain is read; 0: one gain
    std::uint32_t device_id = 0;             ///< selects the fixed pattern
    ColourFilter cfa = ColourFilter::kNone;
    int map_rows = 1;  ///< tile of the two maps, repeated over the array
    int map_cols = 1;
    std::vector<double> transmittance = {};  ///< by row, col of the tile; empty: 1 everywhere
    std::vector<double> gain_map = {};       ///< relative conversion gain, likewise

    bool operator==(const PhysicalTerms&) const = default;
};

}  // namespace stipple
