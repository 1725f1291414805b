#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stipple {

class SampleNoise;
struct Measurements;

/// Samples of DN 0, which hide noise below zero: as equalities they make dark light too bright.
/// During the life of this object their sums are expected values (the E-step of a Tobit model;
/// Dempster, Laird and Rubin, J. R. Stat. Soc. B 39(1), 1977): the mean below half a DN of a normal
/// distribution with the variance of the sample, centred at the light of an estimate. The estimate
/// is averaged over 7 x 7 pixels first, because its own noise would be amplified. Near bright light
/// this average is not below the light, and the sum changes little.
class CensoredSamples {
  public:
    CensoredSamples(Measurements& measurements, const SampleNoise& noise);
    /// Restores the sums.
    ~CensoredSamples();
    CensoredSamples(const CensoredSamples&) = delete;
    CensoredSamples& operator=(const CensoredSamples&) = delete;

    /// Sets the sums to the expected values for the video `x`, and in `copy` too if it is not
    /// empty. Light below 0 counts as 0. Precondition: the variances are those of `x`. The same
    /// bits for any thread count.
    void expect(std::span<const float> x, std::span<float> copy = {});

  private:
    [[nodiscard]] std::vector<float> blurred(std::span<const float> x) const;

    struct Sample {
        std::size_t voxel;
        float sum;       ///< of the sample
        float expected;  ///< present value
    };

    Measurements& measurements_;
    float half_dn_;  ///< light
    std::vector<Sample> samples_;
};

/// phi(z) / Phi(z) of the standard normal distribution, to 1e-4: minus the mean of its part below
/// z. The same bits everywhere.
[[nodiscard]] float inverse_mills_ratio(float z);

}  // namespace stipple
