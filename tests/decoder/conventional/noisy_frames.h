#pragma once

#include "core/flux_video.h"
#include "decoder/conventional/frame_decoding.h"

namespace stipple {

/// Shot noise of 1000 electrons per unit of light, and read noise of 10.
inline constexpr FrameNoise kPaperNoise{.dark_variance = 1e-4F, .per_light = 1e-3F};

/// Frames with nearly normal noise of this variance, from a seed.
[[nodiscard]] DeliveredFrames noisy_frames(const FluxVideo& truth, FrameNoise noise,
                                           std::uint32_t seed = 1);

/// A smooth texture in every frame, which moves by `cols` pixels from frame to frame.
[[nodiscard]] FluxVideo moving_texture(int frames, FrameShape shape, float cols);

/// Light 0.2 and, right of an edge, 0.6; the edge moves by `cols` pixels from frame to frame, from
/// column 20. Its pixel shares the light.
[[nodiscard]] FluxVideo moving_edge(int frames, FrameShape shape, float cols);

/// Mean square error of one frame without `margin` pixels at its rim.
[[nodiscard]] double error_of(const FluxVideo& a, const FluxVideo& truth, int frame,
                              int margin = 8);

}  // namespace stipple
