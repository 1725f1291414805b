#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/homography.h"

namespace stipple {

/// The frames of a sensor that sees the scene of another one through a homography: the light of
/// each of its pixels is interpolated bilinearly at the place that the homography leads from.
/// Beyond the frame of the other sensor the light is that of its nearest edge. An offset of whole
/// pixels copies light exactly. Not modelled: the mean over the area of a pixel where the map
/// shrinks the frame (aliasing). The same bits for any thread count.
class LightWarp {
  public:
    /// Precondition: the map is neither singular nor infinite on a frame of `shape`.
    LightWarp(const Homography& from_reference, FrameShape shape);

    /// The warped frame, order (plane, row, col), valid until the next call; `frame` itself if the
    /// map is the identity.
    [[nodiscard]] std::span<const float> operator()(std::span<const float> frame);

  private:
    /// Of a pixel: weights of the light at four pixels.
    struct Taps {
        std::array<std::uint32_t, 4> pixel;
        std::array<float, 4> weight;
    };
    [[nodiscard]] static Taps taps_at(FramePoint place, FrameShape shape);

    FrameShape shape_;
    std::vector<Taps> taps_;  ///< of each pixel; empty: identity
    std::vector<float> warped_;
};

}  // namespace stipple
