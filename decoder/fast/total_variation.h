#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "decoder/motion/motion.h"

namespace stipple {

struct Measurements;

/// Weights are in 1/flux: the cost of a difference of 1.0 between neighbours, at pixels whose
/// primal step size is `reference_step` (flux^2). At a step size s the weight is
/// sqrt(reference_step / s) times that.
struct TotalVariationOptions {
    int iterations = 20;
    float spatial_weight = 3.5F;
    float temporal_weight = 45;  ///< all links of a voxel together, at full confidence
    float reference_step = 0.005F;
    /// 0: all planes share one norm. Otherwise three planes have a norm for luma and a norm for the
    /// two opponents (pixel_transforms.h), whose weight is larger by this factor.
    float chroma_weight = 0;
    std::function<bool()> keep_going = [] { return true; };  ///< after each iteration; false stops
};

/// Minimises, by the primal-dual method of Chambolle and Pock (2011) from the start x,
///   sum_k (y_k - (A x)_k)^2 / (2 variance_k) + spatial sum |grad x| + temporal sum_links c |D x|
/// where grad x is the forward difference to the right and below, D x = x(partner) - x(voxel)
/// between slots, and c is the confidence of the link. |.| is the Euclidean norm over directions
/// and planes, so that edges of all planes coincide (or one norm over luma and one over the
/// opponents). Motion leads to the partner, by bilinear interpolation; without motion the partner
/// is the same pixel one slot later.
class TotalVariationSolver {
  public:
    /// `measurements` must outlive the solver; its variances may change between calls.
    explicit TotalVariationSolver(const Measurements& measurements);
    ~TotalVariationSolver();
    TotalVariationSolver(const TotalVariationSolver&) = delete;
    TotalVariationSolver& operator=(const TotalVariationSolver&) = delete;

    /// `step` is the primal step size of each pixel (order (slot, row, col), flux^2). With a larger
    /// step size the pixel moves further in an iteration (Pock and Chambolle, ICCV 2011), and its
    /// differences have a smaller weight. The same bits for any thread count and SIMD target. The
    /// work memory, 20 bytes a voxel and 4 more with motion, is kept between calls.
    void minimise(std::span<const MotionField> motion, std::span<const float> step,
                  const TotalVariationOptions& options, FluxVideo& x);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
