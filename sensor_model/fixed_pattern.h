#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Fixed-pattern parameters of one site.
struct SiteParams {
    float responsivity_e = 0;   ///< electrons that flux 1.0 gives per slot
    float dark_e_per_slot = 0;  ///< mean dark electrons of an open slot
    float offset_e = 0;         ///< added in every readout
    float read_noise_e = 0;     ///< read and reset noise, standard deviation
    float gain = 1;             ///< relative conversion gain
};

/// The fixed pattern of the chip `device_id`, independent of the seed of the noise.
///
///     responsivity = r QE T (1 + prnu z0)          T transmittance of the tile; at least 0
///     dark         = t_slot I 2^((T_c - T_ref) / T_double),  I + I_hot in hot pixels
///     offset       = dsnu z1 + column_noise z(column)
///     noise        = sqrt((sigma (1 + s z2))^2 / (1 + s^2) + sigma_reset^2)
///
/// z0, z1, z2 are normal deviates of the words 0, 1, 2 of the Philox block at (pixel, device id,
/// kFixedPattern, plane) with key 0. z(column) is that of word 0 at (column, device id,
/// kColumnPattern, plane). The lowest values of word 3 mark dead pixels, the highest hot pixels.
/// Dead pixels have no responsivity, dark current, DSNU, read noise or reset noise.
///
/// Not modelled: patterns that change with temperature or time, correlation of neighbours, a
/// distribution of dark currents.
class FixedPattern {
  public:
    /// Precondition: `validate(params)` passes.
    FixedPattern(const SensorParams& params, FrameShape shape);

    /// Sites of one plane by row * cols + col. Precondition: plane < planes of the shape.
    [[nodiscard]] const SiteParams* plane(std::uint32_t plane) const noexcept {
        return &sites_[plane * pixels_];
    }

  private:
    std::size_t pixels_;
    std::vector<SiteParams> sites_;  ///< order (plane, row, col)
};

}  // namespace stipple
