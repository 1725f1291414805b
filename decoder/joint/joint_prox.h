#pragma once

#include <span>
#include <vector>

#include "decoder/data_prox.h"

namespace stipple {

/// The proximal map of the data terms of all sensors (Measurements::others),
///   argmin_x  sum_t (x_t - v_t)^2 / (2 step_t) + sum_i sum_k (y_ik - (A_i x)_k)^2 / (2 var_ik),
/// by coordinate ascent of its dual: x = v + step sum_i A_i^T d_i, and in turn each sensor takes
/// the closed form for its own duals d_i (Bauschke and Combettes, Pacific J. Optim. 4(3), 2008).
/// This converges to the exact map. The duals are kept from call to call, so that few sweeps
/// suffice where v changes little, as between iterations of a method: their fixed point has the
/// exact map. For one sensor it is its map, exact and without duals.
class JointProx {
  public:
    static constexpr int kSweeps = 3;

    /// `measurements` must outlive this. Memory: 4 bytes a voxel and sensor if there are several.
    explicit JointProx(const Measurements& measurements);

    /// As `data_prox`. Calls for different runs may be simultaneous. The same bits for any thread
    /// count and SIMD target.
    void operator()(const SiteRun& run, std::span<const float> step, std::span<float> v,
                    int sweeps = kSweeps) noexcept;

  private:
    struct Sensor {
        const Measurements& measurements;
        std::vector<float> dual;
    };
    std::vector<Sensor> sensors_;
};

}  // namespace stipple
