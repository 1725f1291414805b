#include "sensor_model/sensor_config.h"

#include <cmath>

namespace stipple {

emva1288::CameraFigures configured_figures(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    const double alive = 1 - terms.dead_pixel_fraction;
    SensorParams hot = params;
    hot.physical.dark_current_e_per_s = terms.hot_pixel_dark_current;
    const double dark_e = params.dark_e_per_slot();
    const double hot_e = hot.dark_e_per_slot();
    const double share = terms.hot_pixel_fraction;
    const double read_e = params.temporal_read_noise_e();

    emva1288::CameraFigures f;
    f.gain_dn_per_e = 1 / params.gain_e_per_dn();
    f.quantum_efficiency = terms.quantum_efficiency * alive;
    f.dark_noise_e = std::sqrt(read_e * read_e + dark_e + share * hot_e);
    f.saturation_e = params.saturation_e();
    f.dsnu_column_e = terms.column_noise_e;
    f.dsnu_pixel_e = std::hypot(terms.dsnu_e, std::sqrt(share * (1 - share)) * hot_e);
    f.dsnu_e = std::hypot(f.dsnu_pixel_e, f.dsnu_column_e);
    // The high-pass keeps 20 / 25 of the variance of columns; the figure is relative to 24 / 25.
    f.dsnu_high_pass_e = std::hypot(f.dsnu_pixel_e, std::sqrt(20.0 / 24) * f.dsnu_column_e);
    f.prnu = std::sqrt((1 + terms.prnu * terms.prnu) / alive - 1);
    f.prnu_pixel = f.prnu;
    f.prnu_high_pass = f.prnu;
    f.snr_max = std::sqrt(f.saturation_e);
    const double noise2_e2 =
        f.dark_noise_e * f.dark_noise_e + params.gain_e_per_dn() * params.gain_e_per_dn() / 12;
    f.sensitivity_threshold_p = (std::sqrt(noise2_e2 + 0.25) + 0.5) / f.quantum_efficiency;
    f.dynamic_range = f.saturation_e / f.quantum_efficiency / f.sensitivity_threshold_p;
    return f;
}

}  // namespace stipple
