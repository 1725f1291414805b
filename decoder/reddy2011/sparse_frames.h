#pragma once

#include <functional>
#include <vector>

#include "core/flux_video.h"
#include "decoder/reddy2011/flow_links.h"
#include "decoder/reddy2011/wavelet.h"

namespace stipple {

struct Measurements;

/// Weights of a minimisation. light 1.0 is 1.
struct SparseFramesTask {
    int iterations = 0;
    float wavelet_weight = 0;  ///< lambda, flux
    float first_weight = 0;    ///< lambda of the first iteration; falls to lambda in the first half
    float flow_weight = 0;     ///< beta
    const FlowLinks* links = nullptr;  ///< null: no brightness constancy
    /// Receives the number of finished iterations; false stops.
    std::function<bool(int iterations)> keep_going = [](int) { return true; };
};

/// Minimises
///
///     1/2 sum_k (y_k - (A x)_k)^2 / ||a_k||^2 + beta/2 ||B x||^2 + lambda sum_t |W x_t|_1
///
/// over the light x: a_k are the rows of the sampling operator A, B is brightness constancy along
/// flow (flow_links.h), W the wavelet transform of each plane of a slot, without its lowpass
/// corner. A saturated sample has no error if A x is above it. The method is FISTA (Beck and
/// Teboulle 2009) with continuation in lambda.
class SparseFramesSolver {
  public:
    /// Precondition: frames of a shape of WaveletTransform::padded_shape. `measurements` must
    /// outlive the solver.
    SparseFramesSolver(const Measurements& measurements, int max_levels);

    /// In place, from the start x. The same bits for any thread count. Memory: 20 bytes a voxel, of
    /// which 8 are kept between calls.
    void minimise(const SparseFramesTask& task, FluxVideo& x);

  private:
    void data_gradient(const FluxVideo& x, std::span<float> gradient);

    const Measurements& measurements_;
    WaveletTransform wavelet_;
    std::vector<float> inverse_norms_;  ///< 1 / ||a_k||^2 at the last voxel of each exposure
    std::vector<float> residuals_;
};

}  // namespace stipple
