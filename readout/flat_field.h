#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Images of uniform light.
struct FlatFieldExposure {
    double photons = 0;  ///< mean photons per pixel and image; 0: dark
    int images = 0;      ///< their number
};

/// The series of an evaluation by EMVA 1288: a dark pair, 50 bright pairs in equal steps up to 1.15
/// of saturation, 100 images at half of saturation, 100 dark ones.
[[nodiscard]] std::vector<FlatFieldExposure> flat_field_exposures(const SensorParams& params);

/// An emulated sensor of 320 x 240 pixels in front of a field that is lit uniformly: one slot an
/// image, the whole array read in each.
class FlatField {
  public:
    static constexpr FrameShape kShape{.rows = 240, .cols = 320, .planes = 1};

    /// A colour filter array of `params` is removed. \throws InputError if the sensor has maps of
    /// unequal pixels.
    FlatField(SensorParams params, std::uint64_t seed);
    ~FlatField();
    FlatField(const FlatField&) = delete;
    FlatField& operator=(const FlatField&) = delete;

    /// The DN of the next image, by row and column; valid until the next call.
    [[nodiscard]] const std::vector<std::uint16_t>& capture(double photons);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
