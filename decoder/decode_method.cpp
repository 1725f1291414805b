#include "decoder/decode_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "decoder/best/collaborative.h"
#include "decoder/block_partition.h"
#include "decoder/conventional/bennett2005.h"
#include "decoder/conventional/conventional_schedule.h"
#include "decoder/conventional/frame_decoding.h"
#include "decoder/conventional/kang2003.h"
#include "decoder/conventional/shahar2011.h"
#include "decoder/conventional/vbm4d.h"
#include "decoder/conventional/zhang2009.h"
#include "decoder/decode_options.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/frame_exposures.h"
#include "decoder/hitomi2011/hitomi2011.h"
#include "decoder/learned/learned.h"
#include "decoder/live/live_decoder.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"
#include "decoder/plug_and_play/plug_and_play.h"
#include "decoder/portz2013/portz2013.h"
#include "decoder/reddy2011/reddy2011.h"

namespace stipple {
namespace {

/// Arguments of a method with a prior on the video.
struct PriorTask {
    Measurements& measurements;
    const SampleNoise& noise;
    const DecodeOptions& options;
    const ProgressCallback& progress;
};

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

/// Decodes a block by such a method, after the samples of stuck pixels are removed. If all pixels
/// have the same exposures, as in a conventional camera (one sensor), `decode` restores the frames,
/// and the video is interpolated between them.
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

constexpr NamedDecodeMethod kMethods[] = {
    {"naive", DecodeMethod::kNaive, true, false, "nearest samples of each pixel: fast and noisy",
     kMaxCoreSites, 14, 0.1, [](Config&, DecodeOptions&) {},
     [](const BlockTask& block) -> std::optional<FluxVideo> {
         return nearest_samples(block.measurements);
     }},
    {"live", DecodeMethod::kLive, false, false,
     "means along time, and residuals blurred in space: for a picture while filming", kMaxCoreSites,
     30, 0.12, [](Config&, DecodeOptions&) {},
     [](const BlockTask& block) { return decode_live(block.measurements, block.progress); }},
    {"fast", DecodeMethod::kFast, true, false, "motion-compensated total variation", kMaxCoreSites,
     58, 2.1, [](Config& config, DecodeOptions& options) { read_options(config, options.fast); },
     [](const BlockTask& block) {
         return decode_with_prior(block, [](const PriorTask& task) {
             return decode_motion_tv(task.measurements, task.noise, task.options.fast,
                                     task.progress);
         });
     }},
    {"best", DecodeMethod::kBest, true, false,
     "collaborative filter of similar patches: slower, 2 to 3 dB better than fast", kMaxCoreSites,
     58, 11, [](Config& config, DecodeOptions& options) { read_options(config, options.best); },
     [](const BlockTask& block) {
         return decode_with_prior(block, [](const PriorTask& task) {
             return decode_collaborative(task.measurements, task.noise, task.options.best,
                                         task.progress);
         });
     }},
    {"learned_fast", DecodeMethod::kLearnedFast, false, false,
     "fast, refined by a network: 0.8 dB better than fast", kMaxCoreSites, 90, 3.5,
     [](Config& config, DecodeOptions& options) {
         read_options(config, options.fast);
         read_options(config, options.learned);
     },
     [](const BlockTask& block) {
         return decode_with_prior(block, [](const PriorTask& task) {
             return decode_learned_fast({task.measurements, task.noise, task.progress},
                                        task.options.fast, task.options.learned.refine);
         });
     }},
    {"learned", DecodeMethod::kLearned, false, false, "best, refined by a network", kMaxCoreSites,
     90, 12.5,
     [](Config& config, DecodeOptions& options) {
         read_options(config, options.best);
         read_options(config, options.learned);
     },
     [](const BlockTask& block) {
         return decode_with_prior(block, [](const PriorTask& task) {
             return decode_learned({task.measurements, task.noise, task.progress},
                                   task.options.best, task.options.learned.refine);
         });
     }},
    {"plug_and_play", DecodeMethod::kPlugAndPlay, true, false,
     "the iterations of best with a denoiser of your own, a network or in Python", kMaxCoreSites,
     90, 11,
     [](Config& config, DecodeOptions& options) {
         read_options(config, options.best);
         read_options(config, options.plug_and_play);
     },
     [](const BlockTask& block) {
         return decode_with_prior(block, [](const PriorTask& task) {
             return decode_plug_and_play({task.measurements, task.noise, task.progress},
                                         task.options.best, task.options.plug_and_play);
         });
     }},
    {"portz2013", DecodeMethod::kPortz2013, false, true,
     "the method of the paper (Portz, Zhang, Jiang, ICCP 2013), in two stages", kPortz2013CoreSites,
     490, 800,
     [](Config& config, DecodeOptions& options) { read_options(config, options.portz2013); },
     [](const BlockTask& block) {
         return decode_portz2013(block.measurements, block.options.portz2013, block.observer,
                                 block.progress);
     }},
    {"reddy2011", DecodeMethod::kReddy2011, false, true,
     "P2C2 (Reddy, Veeraraghavan, Chellappa, CVPR 2011): wavelets and optical flow", kMaxCoreSites,
     64, 16,
     [](Config& config, DecodeOptions& options) { read_options(config, options.reddy2011); },
     [](const BlockTask& block) {
         return decode_reddy2011(block.measurements, block.options.reddy2011, block.observer,
                                 block.progress);
     }},
    {"hitomi2011", DecodeMethod::kHitomi2011, false, false,
     "patches of a learned dictionary (Hitomi et al., ICCV 2011); needs one", kMaxCoreSites, 64, 34,
     [](Config& config, DecodeOptions& options) { read_options(config, options.hitomi2011); },
     [](const BlockTask& block) {
         return decode_hitomi2011(block.measurements, block.options.hitomi2011, block.progress);
     }},
    {"interpolated", DecodeMethod::kInterpolated, false, false,
     "conventional cameras only: frames as delivered, interpolated along motion", kMaxCoreSites, 38,
     0.8, [](Config&, DecodeOptions&) {},
     [](const BlockTask& block) {
         return decode_frames(block, [](const DeliveredFrames& frames, const ProgressCallback&) {
             return std::optional(frames.light);
         });
     },
     require_conventional},
    {"bennett2005", DecodeMethod::kBennett2005, false, false,
     "conventional cameras only: adaptive spatio-temporal accumulation (Bennett, McMillan 2005)",
     kMaxCoreSites, 60, 1.1,
     [](Config& config, DecodeOptions& options) { read_options(config, options.bennett2005); },
     [](const BlockTask& block) {
         return decode_frames(
             block, [&](const DeliveredFrames& frames, const ProgressCallback& progress) {
                 return accumulate_samples(frames, block.options.bennett2005, progress);
             });
     },
     require_conventional},
    {"zhang2009", DecodeMethod::kZhang2009, false, false,
     "conventional cameras only: denoising along optical flow (after Zhang et al. 2009)",
     kMaxCoreSites, 60, 1.1,
     [](Config& config, DecodeOptions& options) { read_options(config, options.zhang2009); },
     [](const BlockTask& block) {
         return decode_frames(
             block, [&](const DeliveredFrames& frames, const ProgressCallback& progress) {
                 return denoise_along_flow(frames, block.options.zhang2009, progress);
             });
     },
     require_conventional},
    {"vbm4d", DecodeMethod::kVbm4d, false, false,
     "conventional cameras only: collaborative filter of volumes (after V-BM4D, 2012)",
     kMaxCoreSites, 60, 2.7,
     [](Config& config, DecodeOptions& options) { read_options(config, options.vbm4d); },
     [](const BlockTask& block) {
         return decode_frames(block,
                              [&](const DeliveredFrames& frames, const ProgressCallback& progress) {
                                  return filter_volumes(frames, block.options.vbm4d, progress);
                              });
     },
     require_conventional},
    {"shahar2011", DecodeMethod::kShahar2011, false, false,
     "conventional cameras only: temporal super-resolution (after Shahar, Faktor, Irani 2011)",
     kMaxCoreSites, 60, 29,
     [](Config& config, DecodeOptions& options) { read_options(config, options.shahar2011); },
     [](const BlockTask& block) { return super_resolve_time(block, block.options.shahar2011); },
     require_conventional},
    {"kang2003", DecodeMethod::kKang2003, false, false,
     "alternating exposure times only: HDR video, merged along motion (after Kang et al. 2003)",
     kMaxCoreSites, 44, 1.6, [](Config&, DecodeOptions&) {}, merge_exposure_times,
     require_alternating},
};

}  // namespace

std::span<const NamedDecodeMethod> decode_methods() {
    return kMethods;
}

const NamedDecodeMethod& named(DecodeMethod method) {
    return *std::ranges::find(kMethods, method, &NamedDecodeMethod::method);
}

DecodeMethod decode_method_from_name(std::string_view name) {
    std::vector<std::string> names;
    for (const NamedDecodeMethod& known : kMethods) {
        if (known.name == name) return known.method;
        names.emplace_back(known.name);
    }
    throw InputError("decoding method",
                     fmt::format("\"{}\" is unknown; {}", name, suggestion(name, names)));
}

DecodeOptions read_decode_options(DecodeMethod method, Config& config) {
    DecodeOptions options{.method = method};
    named(method).read_options(config, options);
    config.reject_unknown_keys();
    return options;
}

}  // namespace stipple
