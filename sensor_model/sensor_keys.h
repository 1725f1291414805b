#pragma once

#include <array>
#include <string_view>

#include "core/config.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

// The keys of a sensor file without its section [timing]. The reader, the checks of ranges and the
// provenance of a stream use these lists: they call `visit(key, member)` for each key. Members of a
// const object are const.

inline constexpr auto kSensorModes = std::to_array<NamedValue<SensorMode>>(
    {{"paper", SensorMode::kPaper}, {"physical", SensorMode::kPhysical}});

/// Max number of values of `row_noise_e`, and max rows and columns of the tile of the maps.
inline constexpr int kMaxTaps = 64;
inline constexpr int kMaxMapSide = 64;

/// The keys of both modes.
template <typename Params, typename Visit>
void visit_sensor_keys(Params& params, const Visit& visit) {
    visit({"name", {}, "", "name in messages and in the provenance of streams"}, params.name);
    visit({"photons_per_unit", {1e-3, 1e7}, "photons", "r: mean per slot and site at flux 1.0"},
          params.photons_per_unit);
    visit({"full_scale_e", {1, 1e7}, "electrons", "s: charge of the highest DN"},
          params.full_scale_e);
    visit({"full_well_e", {1, 1e7}, "electrons", "w: full well; charge beyond it is lost"},
          params.full_well_e);
    visit({"read_noise_e", {0, 1e5}, "electrons", "sigma: standard deviation of read noise"},
          params.read_noise_e);
    visit({"shot_noise", {}, "", "Poisson noise of the charge; false: the charge is its mean"},
          params.shot_noise);
    visit({"bit_depth", {1, 16}, "bits", "d: bit depth; the highest DN is 2^d - 1"},
          params.bit_depth);
    visit({"rounding", {}, "", "rounding of the converter", kNamesOf<kRoundings>}, params.rounding);
    visit({"slot_us", {1e-3, 1e9}, "us", "length of a time slot, one frame of the footage"},
          params.slot_us);
    visit({"charge_stores", {1, 2}, "", "charge stores of a pixel: exposures under way at once"},
          params.charge_stores);
    visit({"mode", {}, "", "terms of Eq. 1, or those of EMVA 1288 as well", kNamesOf<kSensorModes>},
          params.mode);
}

/// The keys of mode "physical" by which pixels and exposures share light.
template <typename Terms, typename Visit>
void visit_shared_light_keys(Terms& terms, const Visit& visit) {
    visit({"crosstalk", {0, 0.8}, "", "fraction of light that reaches the four neighbours"},
          terms.crosstalk);
    visit({"blooming", {0, 1}, "", "fraction of overflow that reaches the four neighbours"},
          terms.blooming);
    visit({"lag", {0, 0.5}, "", "fraction of charge that stays for the next exposure"}, terms.lag);
    visit({"parasitic_light_sensitivity", {0, 1}, "", "fraction of light of a closed charge store"},
          terms.parasitic_light_sensitivity);
    visit({"row_skew_slots", {0, 1}, "slots", "delay of the last row behind the first"},
          terms.row_skew_slots);
}

/// The keys of mode "physical" of dark currents and their temperature.
template <typename Terms, typename Visit>
void visit_dark_keys(Terms& terms, const Visit& visit) {
    visit({"dark_current_e_per_s", {0, 1e9}, "electrons/s", "dark current at dark_reference_c"},
          terms.dark_current_e_per_s);
    visit({"dark_reference_c", {-200, 200}, "degrees Celsius", "where dark currents are given"},
          terms.dark_reference_c);
    visit({"temperature_c", {-200, 200}, "degrees Celsius", "temperature of the chip"},
          terms.temperature_c);
    visit({"dark_doubling_c", {1, 100}, "kelvins", "step that doubles the dark current"},
          terms.dark_doubling_c);
    visit({"temperature_drift_c_per_s", {-100, 100}, "kelvins/s", "rise of temperature_c"},
          terms.temperature_drift_c_per_s);
    visit({"storage_dark_current_e_per_s",
           {0, 1e9},
           "electrons/s",
           "of charge that waits to be read"},
          terms.storage_dark_current_e_per_s);
    visit({"storage_wait_us", {0, 1e9}, "us", "scan of all rows: a row waits row / rows of it"},
          terms.storage_wait_us);
}

/// The keys of mode "physical" only.
template <typename Terms, typename Visit>
void visit_physical_keys(Terms& terms, const Visit& visit) {
    visit({"quantum_efficiency", {1e-3, 1}, "electrons/photon", "quantum efficiency"},
          terms.quantum_efficiency);
    visit_dark_keys(terms, visit);
    visit({"dsnu_e", {0, 1e5}, "electrons", "DSNU: standard deviation of the pixels' offsets"},
          terms.dsnu_e);
    visit({"prnu", {0, 0.5}, "", "PRNU: relative standard deviation of the responsivity"},
          terms.prnu);
    visit({"read_noise_spread", {0, 1}, "", "relative spread of read_noise_e over the pixels"},
          terms.read_noise_spread);
    visit({"reset_noise_e", {0, 1e5}, "electrons", "standard deviation of reset (kTC) noise"},
          terms.reset_noise_e);
    visit({"row_noise_e", {0, 1e5}, "electrons", "standard deviation of row noise, by tap"},
          terms.row_noise_e);
    visit({"column_noise_e", {0, 1e5}, "electrons", "standard deviation of column offsets"},
          terms.column_noise_e);
    visit({"column_temporal_noise_e", {0, 1e5}, "electrons", "sigma of column noise, by slot"},
          terms.column_temporal_noise_e);
    visit({"black_level_dn", {0, 65535}, "DN", "of no charge; absent: 4 sigma of a dark sample"},
          terms.black_level_dn);
    visit({"response_loss", {0, 0.4}, "", "non-linearity: relative loss at the full well"},
          terms.response_loss);
    visit({"low_gain_read_noise_e", {0, 1e5}, "electrons", "sigma above dual_gain_limit_e"},
          terms.low_gain_read_noise_e);
    visit({"dual_gain_limit_e", {0, 1e7}, "electrons", "charge up to which high gain is read"},
          terms.dual_gain_limit_e);
    visit({"inl_dn", {-1000, 1000}, "DN", "INL: peak of the converter's integral non-linearity"},
          terms.inl_dn);
    visit({"dnl_dn", {0, 0.5}, "DN", "DNL: largest differential non-linearity of the converter"},
          terms.dnl_dn);
    visit({"hot_pixel_fraction", {0, 0.5}, "", "share of hot pixels"}, terms.hot_pixel_fraction);
    visit({"hot_pixel_dark_current", {0, 1e9}, "electrons/s", "added dark current of hot pixels"},
          terms.hot_pixel_dark_current);
    visit({"dead_pixel_fraction", {0, 0.5}, "", "share of dead pixels"}, terms.dead_pixel_fraction);
    visit_shared_light_keys(terms, visit);
    visit({"device_id", {0, 4294967295}, "", "which chip: seed of the fixed pattern"},
          terms.device_id);
    visit({"cfa", {}, "", "colour filter array", kNamesOf<kColourFilters>}, terms.cfa);
    visit({"map_rows", {1, kMaxMapSide}, "pixels", "rows of the tile of the two maps"},
          terms.map_rows);
    visit({"map_cols", {1, kMaxMapSide}, "pixels", "columns of the tile of the two maps"},
          terms.map_cols);
    visit({"transmittance", {1e-3, 1}, "", "of the filters, by row, col of the tile; []: 1"},
          terms.transmittance);
    visit({"gain_map", {1e-3, 1e3}, "", "relative conversion gain by row, col of the tile; []: 1"},
          terms.gain_map);
}

/// Default black level of physical mode, in DN: four standard deviations of a dark sample, rounded
/// up to a whole DN; 0 without noise.
[[nodiscard]] double default_black_level_dn(const SensorParams& params);

}  // namespace stipple
