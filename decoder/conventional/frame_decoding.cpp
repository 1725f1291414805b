#include "decoder/conventional/frame_decoding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/decode_method.h"
#include "decoder/decode_options.h"
#include "decoder/frame_exposures.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

std::vector<float> bounds_of(const Measurements& frames) {
    constexpr std::uint8_t kBound = Measurements::kLast | Measurements::kSaturated;
    std::vector<float> bounds(frames.voxels());
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if ((frames.state[i] & kBound) == kBound) bounds[i] = frames.sum[i];
    return bounds;
}

}  // namespace

FrameNoise noise_of_samples(const Measurements& frames) {
    double dark_variance = 0;
    double per_light = 0;
    std::int64_t samples = 0;
    for (std::size_t i = 0; i < frames.voxels(); ++i) {
        if ((frames.state[i] & Measurements::kLast) == 0) continue;
        dark_variance += static_cast<double>(frames.dark_variance[i]);
        per_light += static_cast<double>(frames.variance_per_light[i]);
        ++samples;
    }
    if (samples == 0) return {};
    const auto mean = [&](double sum) {
        return static_cast<float>(sum / static_cast<double>(samples));
    };
    return {mean(dark_variance), mean(per_light)};
}

std::vector<FrameExposure> exposures_of_frames(const Measurements& measurements,
                                               FrameLengths lengths) {
    auto exposures = shared_exposures(measurements);
    if (!exposures)
        throw InputError("samples",
                         "pixels have different exposures; this method takes the frames of a "
                         "conventional camera");
    if (lengths == FrameLengths::kEqual && !equally_long(*exposures))
        throw InputError("samples",
                         "exposures have different lengths; of the methods of conventional "
                         "cameras only kang2003 takes them");
    return std::move(*exposures);
}

DeliveredFrames delivered_frames(const BlockTask& block, std::span<const FrameExposure> exposures) {
    Measurements frames =
        measurements_of_frames(block.measurements, exposures, SampleNoise(block.calibration));
    mask_defects(frames);
    return {nearest_samples(frames), noise_of_samples(frames), bounds_of(frames)};
}

std::optional<FluxVideo> decode_frames(const BlockTask& block, const FrameFilter& filter) {
    const Measurements& measurements = block.measurements;
    const auto exposures = exposures_of_frames(measurements);
    if (exposures.empty()) return FluxVideo(measurements.slots, measurements.shape);
    DeliveredFrames frames = delivered_frames(block, exposures);
    const bool noisy = !block.calibration.noise_free && frames.noise.per_light > 0;
    std::optional<FluxVideo> lights =
        noisy ? filter(frames, block.progress) : std::move(frames.light);
    if (!lights) return {};
    for (std::size_t i = 0; i < lights->voxels(); ++i)
        if (frames.bounds[i] > 0) lights->data()[i] = std::max(lights->data()[i], frames.bounds[i]);
    return video_of_frames(measurements, exposures, *lights);
}

StabilisedFrames stabilised(const DeliveredFrames& frames) {
    constexpr float kMaxOffset = 1e3F;  // flux; where noise is larger than that, light is not seen
    const FluxVideo& light = frames.light;
    const float offset = std::min(frames.noise.dark_variance / frames.noise.per_light, kMaxOffset);
    StabilisedFrames result{FluxVideo(light.slots(), light.shape()),
                            AnscombeParams{.offset = offset, .min_light = -offset},
                            std::sqrt(frames.noise.per_light)};
    parallel_for(0, light.slots(), [&](int frame) {
        stabilise_variance(light.frame(frame), light.shape().planes, result.scale,
                           result.values.frame(frame));
    });
    return result;
}

FluxVideo restored(const FluxVideo& values, AnscombeParams scale, const FrameNoise& noise) {
    FluxVideo light(values.slots(), values.shape());
    parallel_for(0, values.slots(), [&](int frame) {
        restore_light(values.frame(frame), values.shape().planes, scale, light.frame(frame));
        for (float& x : light.frame(frame)) x += noise.per_light / 4;
    });
    return light;
}

}  // namespace stipple
