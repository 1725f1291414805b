#pragma once

#include <array>

#include "sensor_model/sensor_params.h"

namespace stipple {

/// A number of the physical mode as configuration files name it.
struct PhysicalKey {
    const char* name;
    double PhysicalTerms::*term;
    ParameterRange range;
};

inline constexpr std::array kPhysicalKeys{
    PhysicalKey{"quantum_efficiency", &PhysicalTerms::quantum_efficiency, {1e-3, 1}},
    PhysicalKey{"dark_current_e_per_s", &PhysicalTerms::dark_current_e_per_s, {0, 1e9}},
    PhysicalKey{"dark_reference_c", &PhysicalTerms::dark_reference_c, {-200, 200}},
    PhysicalKey{"temperature_c", &PhysicalTerms::temperature_c, {-200, 200}},
    PhysicalKey{"dark_doubling_c", &PhysicalTerms::dark_doubling_c, {1, 100}},
    PhysicalKey{"dsnu_e", &PhysicalTerms::dsnu_e, {0, 1e5}},
    PhysicalKey{"prnu", &PhysicalTerms::prnu, {0, 0.5}},
    PhysicalKey{"read_noise_spread", &PhysicalTerms::read_noise_spread, {0, 1}},
    PhysicalKey{"reset_noise_e", &PhysicalTerms::reset_noise_e, {0, 1e5}},
    PhysicalKey{"column_noise_e", &PhysicalTerms::column_noise_e, {0, 1e5}},
    PhysicalKey{"black_level_dn", &PhysicalTerms::black_level_dn, {0, 65535}},
    PhysicalKey{"inl_dn", &PhysicalTerms::inl_dn, {-1000, 1000}},
    PhysicalKey{"dnl_dn", &PhysicalTerms::dnl_dn, {0, 0.5}},
    PhysicalKey{"hot_pixel_fraction", &PhysicalTerms::hot_pixel_fraction, {0, 0.5}},
    PhysicalKey{"hot_pixel_dark_current", &PhysicalTerms::hot_pixel_dark_current, {0, 1e9}},
    PhysicalKey{"dead_pixel_fraction", &PhysicalTerms::dead_pixel_fraction, {0, 0.5}}};

/// Most values of `row_noise_e`, and most rows and columns of the tile of the maps.
inline constexpr int kMaxTaps = 64;
inline constexpr int kMaxMapSide = 64;

inline constexpr ParameterRange kRowNoiseE{0, 1e5};
inline constexpr ParameterRange kTransmittance{1e-3, 1};
inline constexpr ParameterRange kRelativeGain{1e-3, 1e3};

/// Black level that physical mode takes where none is given: four standard deviations of what
/// a dark sample reads, in whole DN, rounded up; 0 without noise.
[[nodiscard]] double default_black_level_dn(const SensorParams& params);

}  // namespace stipple
