#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/pixel_transforms.h"

namespace stipple {

struct BlockTask;
struct FrameExposure;
struct Measurements;

/// Noise of the frames of a conventional camera: variance of the light per slot x is dark_variance
/// + per_light x, the mean over all samples. Pixels that differ are not distinguished.
struct FrameNoise {
    float dark_variance = 0;
    float per_light = 0;

    [[nodiscard]] float variance(float light) const {
        return dark_variance + per_light * (light > 0 ? light : 0);
    }
};

/// The frames of a conventional camera as they are delivered, in light per slot. Missing samples
/// and colours are filled by `nearest_samples`; a saturated sample is its bound.
struct DeliveredFrames {
    FluxVideo light;
    FrameNoise noise;
    std::vector<float> bounds = {};  ///< of the light where samples are saturated, elsewhere 0
};

/// Denoises frames; per_light of their noise is above 0. Returns nothing if `progress` has stopped
/// it.
using FrameFilter = std::function<std::optional<FluxVideo>(const DeliveredFrames& frames,
                                                           const ProgressCallback& progress)>;

/// Decodes the samples of a conventional camera: frames as delivered, without those of stuck
/// pixels, then the filter, then the video between the frames (frame_exposures.h). Where a sample
/// is saturated, the filtered light is at least its bound. Frames without noise are not filtered.
/// Without any sample the video is black. \throws InputError if the samples are not those of
/// frames.
[[nodiscard]] std::optional<FluxVideo> decode_frames(const BlockTask& block,
                                                     const FrameFilter& filter);

enum class FrameLengths { kEqual, kAny };

/// The frames of a block; none without samples. \throws InputError as decode_frames.
[[nodiscard]] std::vector<FrameExposure> exposures_of_frames(
    const Measurements& measurements, FrameLengths lengths = FrameLengths::kEqual);

/// Their light, without the samples of stuck pixels.
[[nodiscard]] DeliveredFrames delivered_frames(const BlockTask& block,
                                               std::span<const FrameExposure> exposures);

/// The mean noise of the samples of frames.
[[nodiscard]] FrameNoise noise_of_samples(const Measurements& frames);

/// Frames after 2 sqrt(x + d), d = dark_variance / per_light, whose noise has the standard
/// deviation `sigma` everywhere; three planes as luma and opponent colours.
struct StabilisedFrames {
    FluxVideo values;
    AnscombeParams scale;
    float sigma = 0;
};

[[nodiscard]] StabilisedFrames stabilised(const DeliveredFrames& frames);

/// The light of frames without noise: y^2 / 4 - d + per_light / 4. The last term corrects the mean
/// of square roots, which is below the square root of the mean.
[[nodiscard]] FluxVideo restored(const FluxVideo& values, AnscombeParams scale,
                                 const FrameNoise& noise);

}  // namespace stipple
