#pragma once

#include <array>
#include <string_view>

namespace stipple::emva1288 {

/// Figures of a camera, in the terms of EMVA 1288 (linear cameras); formulas in
/// docs/characterize.md.
struct CameraFigures {
    double gain_dn_per_e = 0;            ///< K
    double quantum_efficiency = 0;       ///< eta
    double dark_noise_e = 0;             ///< sigma_d, temporal
    double saturation_e = 0;             ///< mu_e.sat
    double dsnu_e = 0;                   ///< DSNU1288
    double dsnu_row_e = 0;               ///< DSNU1288.row
    double dsnu_column_e = 0;            ///< DSNU1288.col
    double dsnu_pixel_e = 0;             ///< DSNU1288.pixel
    double dsnu_high_pass_e = 0;         ///< DSNU1288 without shading
    double prnu = 0;                     ///< PRNU1288, a fraction, as the next four
    double prnu_row = 0;                 ///< PRNU1288.row
    double prnu_column = 0;              ///< PRNU1288.col
    double prnu_pixel = 0;               ///< PRNU1288.pixel
    double prnu_high_pass = 0;           ///< PRNU1288 without shading
    double snr_max = 0;                  ///< sqrt(mu_e.sat)
    double sensitivity_threshold_p = 0;  ///< mu_p.min, photons with SNR 1
    double dynamic_range = 0;            ///< mu_p.sat / mu_p.min
    double linearity_error = 0;          ///< LE, a fraction; NaN from less than two points
};

/// A figure and its key in reports.
struct NamedFigure {
    std::string_view key;
    double CameraFigures::*figure;
};

inline constexpr std::array<NamedFigure, 18> kNamedFigures{
    {{"gain_dn_per_e", &CameraFigures::gain_dn_per_e},
     {"quantum_efficiency", &CameraFigures::quantum_efficiency},
     {"dark_noise_e", &CameraFigures::dark_noise_e},
     {"saturation_e", &CameraFigures::saturation_e},
     {"dsnu_e", &CameraFigures::dsnu_e},
     {"dsnu_row_e", &CameraFigures::dsnu_row_e},
     {"dsnu_column_e", &CameraFigures::dsnu_column_e},
     {"dsnu_pixel_e", &CameraFigures::dsnu_pixel_e},
     {"dsnu_high_pass_e", &CameraFigures::dsnu_high_pass_e},
     {"prnu", &CameraFigures::prnu},
     {"prnu_row", &CameraFigures::prnu_row},
     {"prnu_column", &CameraFigures::prnu_column},
     {"prnu_pixel", &CameraFigures::prnu_pixel},
     {"prnu_high_pass", &CameraFigures::prnu_high_pass},
     {"snr_max", &CameraFigures::snr_max},
     {"sensitivity_threshold_p", &CameraFigures::sensitivity_threshold_p},
     {"dynamic_range", &CameraFigures::dynamic_range},
     {"linearity_error", &CameraFigures::linearity_error}}};

}  // namespace stipple::emva1288
