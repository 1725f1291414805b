#include "decoder/prior_decoding.h"

#include "decoder/decode_options.h"
#include "decoder/defects.h"
#include "decoder/frame_exposures.h"
#include "decoder/frame_video.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

/// A frame's one exposure has all its read noise, most of it below 0 where it is dark.
DecodeOptions options_of_frames(const BlockTask& block, std::span<const FrameExposure> exposures) {
    DecodeOptions options = block.options;
    if (block.calibration.noise_free)
        options.best = without_noise(options.best);
    else if (exposures.front().open_slots == 1 && !block.measurements.mosaic)
        options.best = for_direct_samples(options.best);
    options.best.offset_slots = 1;
    options.best.min_light = -1;
    return options;
}

}  // namespace

std::optional<FluxVideo> decode_with_prior(
    const BlockTask& block, std::optional<FluxVideo> (*decode)(const PriorTask& task)) {
    const SampleNoise noise(block.calibration);
    Measurements& measurements = block.measurements;
    const auto exposures = measurements.others.empty()
                               ? frame_exposures(measurements)
                               : std::optional<std::vector<FrameExposure>>();
    if (!exposures) {
        for_each_sensor(measurements, [](Measurements& sensor) { mask_defects(sensor); });
        DecodeOptions options = block.options;
        if (block.calibration.noise_free) options.best = without_noise(options.best);
        return decode({measurements, noise, options, block.progress});
    }
    Measurements frames = measurements_of_frames(measurements, *exposures, noise);
    mask_defects(frames);
    const auto lights = decode({frames, noise_of_frames(block.calibration, *exposures),
                                options_of_frames(block, *exposures), block.progress});
    if (!lights) return {};
    return video_of_frames(measurements, *exposures, *lights);
}

}  // namespace stipple
