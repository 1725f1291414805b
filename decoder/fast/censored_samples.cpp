#include "decoder/fast/censored_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "decoder/fast/box_blur.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

/// The ratio at steps of 1/16 from -8 to 8, in steps of 2^-20, so that its bits do not hang on a
/// library's exp and erfc.
class RatioTable {
  public:
    static constexpr int kLimit = 8;

    RatioTable() {
        for (std::size_t i = 0; i < ratio_.size(); ++i) {
            const double z = static_cast<double>(i) / kPerUnit - kLimit;
            const double below = std::erfc(-z / std::numbers::sqrt2) / 2;
            const double density =
                std::exp(-z * z / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
            ratio_[i] = static_cast<float>(std::round(density / below * 0x1p20) * 0x1p-20);
        }
    }

    /// Precondition: -kLimit <= z < kLimit.
    [[nodiscard]] float operator()(float z) const {
        const float at = (z + kLimit) * kPerUnit;
        const auto i = static_cast<std::size_t>(at);
        return ratio_[i] + (at - static_cast<float>(i)) * (ratio_[i + 1] - ratio_[i]);
    }

  private:
    static constexpr int kPerUnit = 16;
    std::array<float, 2 * kLimit * kPerUnit + 1> ratio_{};
};

}  // namespace

float inverse_mills_ratio(float z) {
    static const RatioTable ratio;
    constexpr float kLimit = RatioTable::kLimit;
    if (z >= kLimit) return 0;
    return z < -kLimit ? ratio(-kLimit) - kLimit - z : ratio(z);
}

CensoredSamples::CensoredSamples(Measurements& measurements, const SampleNoise& noise)
    : measurements_(measurements),
      half_dn_((measurements.lsb_light > 0 ? measurements.lsb_light : noise.lsb_light()) / 2) {
    for (std::size_t i = 0; i < measurements.voxels(); ++i)
        if ((measurements.state[i] & Measurements::kZero) != 0)
            samples_.push_back({i, measurements.sum[i], measurements.sum[i]});
}

CensoredSamples::~CensoredSamples() {
    for (const Sample& s : samples_) measurements_.sum[s.voxel] = s.sum;
}

std::vector<float> CensoredSamples::blurred(std::span<const float> x) const {
    std::vector<float> result(x.begin(), x.end());
    const FrameShape shape = measurements_.shape;
    parallel_for(0, measurements_.slots * shape.planes, [&](int plane) {
        const auto first = static_cast<std::size_t>(plane) * shape.pixels();
        const auto light = std::span(result).subspan(first, shape.pixels());
        for (float& value : light) value = std::max(value, 0.0F);
        box_blur(shape, light);
    });
    return result;
}

void CensoredSamples::expect(std::span<const float> x, std::span<float> copy) {
    if (samples_.empty()) return;
    std::vector<float> lights = blurred(x);
    sample(measurements_, lights, lights);  // in place: each voxel is read before it is written
    for (Sample& s : samples_) {
        const float light = lights[s.voxel];
        const float deviation = std::sqrt(measurements_.variance[s.voxel]);
        const float ratio = inverse_mills_ratio((s.sum + half_dn_ - light) / deviation);
        const float change = light - deviation * ratio - s.expected;
        if (!std::isfinite(change)) continue;  // noise that no sensor has
        s.expected += change;
        measurements_.sum[s.voxel] += change;
        if (!copy.empty()) copy[s.voxel] += change;
    }
}

}  // namespace stipple
