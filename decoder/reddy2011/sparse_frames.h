#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "core/geometry.h"
#include "core/plane.h"
#include "decoder/motion/motion.h"

namespace stipple {

struct Measurements;

/// Orthonormal wavelet transform of planes, periodic, by Daubechies' wavelet with four vanishing
/// moments (8 taps). Each level halves the rows and columns of the lowpass corner. The same bits
/// for any SIMD target.
class WaveletTransform {
  public:
    /// At most `max_levels` levels; fewer if the lowpass corner would be less than 4 x 4.
    /// Precondition: a shape of `padded_shape`.
    WaveletTransform(FrameShape shape, int max_levels);

    /// `shape` with rows and columns rounded up to what all levels can halve.
    [[nodiscard]] static FrameShape padded_shape(FrameShape shape, int max_levels);

    [[nodiscard]] int levels() const { return levels_; }

    /// In place: light to coefficients, the lowpass corner first. Precondition: a plane of the
    /// shape.
    void forward(PlaneView<float> plane) const;
    /// The inverse, which is the adjoint too.
    void inverse(PlaneView<float> plane) const;

    /// Soft threshold of all coefficients outside the lowpass corner: the proximal map of threshold
    /// times the sum of their absolute values.
    void shrink(PlaneView<float> coefficients, float threshold) const;

  private:
    int rows_;
    int cols_;
    int levels_;
};

/// Brightness constancy along optical flow: B x, with a row for each pixel whose flow is
/// consistent,
///
///     (B x)_p = x(p + flow, next slot) - x(p, slot),
///
/// interpolated bilinearly, and the same for the flow to the slot before.
class FlowLinks {
  public:
    /// Links of pixels with at least `min_confidence` (0..1); `shape` is that of the video.
    /// Precondition: rows, cols >= 2.
    FlowLinks(std::vector<MotionField> motion, FrameShape shape, float min_confidence);

    /// gradient += weight B^T B x. The same bits for any thread count.
    void add_gradient(const FluxVideo& x, float weight, std::span<float> gradient) const;

    /// An upper bound of the squared norm of B: the largest sum of absolute values in a row times
    /// that in a column.
    [[nodiscard]] float squared_norm_bound() const;

    /// Fraction of the pixels and directions with a link, 0..1.
    [[nodiscard]] double share() const;

  private:
    [[nodiscard]] int slots() const;

    std::vector<MotionField> motion_;
    FrameShape shape_;
};

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
/// flow (FlowLinks), W the wavelet transform of each plane of a slot, without its lowpass
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
