#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decoder/measurements.h"
#include "decoder/pixel_response.h"

namespace stipple {

/// The samples of a window as a function of its light x: y = A x + noise, where the noise of a
/// sample is normal with the variance of its light (A x). Arrays have the order of Measurements,
/// (slot, plane, row, col), in the units of FluxVideo; a sample stands at the last voxel of its
/// exposure, and other voxels of y are 0. Saturated samples and those of DN 0 are bounds: the light
/// is y or more, and y or less. Results of forward, adjoint and prox have the same bits for any
/// thread count.
///
/// *Not modelled*: Poisson statistics of a few electrons, and the part of a variance that rounding
/// of the light near DN 0 cuts off.
class ForwardModel {
  public:
    /// \throws InputError if the window has more than kMaxRunSlots slots.
    ForwardModel(Measurements measurements, const Calibration& calibration);

    [[nodiscard]] int slots() const { return measurements_.slots; }
    [[nodiscard]] FrameShape shape() const { return measurements_.shape; }
    [[nodiscard]] std::span<const float> samples() const { return measurements_.sum; }
    [[nodiscard]] const Measurements& measurements() const { return measurements_; }
    /// Of samples that have no own noise (Measurements::dark_variance).
    [[nodiscard]] const SampleNoise& noise() const { return noise_; }
    /// Replaces the samples; those that are bounds are bounds no more. The variances are those of
    /// this light.
    void set_samples(std::span<const float> y);
    /// The variances that `prox` uses become those of the light of an estimate; at first they are
    /// those of samples that equal their mean.
    void set_variances(std::span<const float> x);

    /// y = A x.
    void forward(std::span<const float> x, std::span<float> y) const;
    /// x = A^T y.
    void adjoint(std::span<const float> y, std::span<float> x) const;
    /// Proximal map of the data term (data_prox.h), in place; bounds only move light that breaks
    /// them. `step`: one value for each slot and pixel, for all planes.
    void prox(std::span<const float> step, std::span<float> v) const;
    /// Variance of each sample if the light is x.
    void noise_variance(std::span<const float> x, std::span<float> variance) const;
    /// Logarithm of the probability density of the samples if the light is x; of bounds, of their
    /// probability.
    [[nodiscard]] double log_likelihood(std::span<const float> x) const;
    /// Its gradient. The variances change with x, too.
    void score(std::span<const float> x, std::span<float> gradient) const;

  private:
    [[nodiscard]] float variance_of(std::size_t voxel, float light) const;

    Measurements measurements_;
    SampleNoise noise_;
};

}  // namespace stipple
