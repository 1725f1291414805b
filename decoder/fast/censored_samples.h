#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stipple {

class SampleNoise;
struct Measurements;

/// Samples of DN 0, behind which noise below zero hides: taken for equalities they make dark light
/// brighter. While it lives, their sums are what they are expected to have been (the E-step of a
/// Tobit model; Dempster, Laird and Rubin, J. R. Stat. Soc. B 39(1), 1977): of a normal
/// distribution with the sample's variance around the light of an estimate, the mean of what lies
/// below half a DN. The estimate's mean over 7 x 7 pixels is taken, for its own noise would come
/// back larger; near something bright that is no less than the light, and changes little.
class CensoredSamples {
  public:
    CensoredSamples(Measurements& measurements, const SampleNoise& noise);
    /// Restores the sums.
    ~CensoredSamples();
    CensoredSamples(const CensoredSamples&) = delete;
    CensoredSamples& operator=(const CensoredSamples&) = delete;

    /// Changes the sums to those expected where the video is `x`, in `copy`, if it is not empty, as
    /// well. Light below 0 counts as 0. Precondition: the variances are those of `x`. The same bits
    /// for any thread count.
    void expect(std::span<const float> x, std::span<float> copy = {});

  private:
    [[nodiscard]] std::vector<float> blurred(std::span<const float> x) const;

    struct Sample {
        std::size_t voxel;
        float sum;       ///< as it was read
        float expected;  ///< as it is
    };

    Measurements& measurements_;
    float half_dn_;  ///< light
    std::vector<Sample> samples_;
};

/// phi(z) / Phi(z) of the standard normal distribution, to 1e-4: by how many standard deviations
/// the mean of what lies below z of them falls short of the mean of all. The same bits everywhere.
[[nodiscard]] float inverse_mills_ratio(float z);

}  // namespace stipple
