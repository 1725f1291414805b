#pragma once

#include <span>
#include <vector>

#include "core/flux_video.h"
#include "decoder/motion/motion.h"

namespace stipple {

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

}  // namespace stipple
