#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/conventional/frame_decoding.h"
#include "decoder/conventional/frame_octave.h"

namespace stipple {

class Config;
struct BlockTask;

/// Options of the method `bennett2005`; docs/decoder_conventional.md has the formulas.
struct Bennett2005Options {
    int reach_frames = 4;           ///< frames before and after that are accumulated
    float range_sigma = 1;          ///< of the excess distance D - 1 of two neighbourhoods
    float target_noise = 0.01F;     ///< sets the samples that a pixel needs, relative to its light
    int max_samples = 16;           ///< that a pixel needs
    int radius_px = 3;              ///< of the spatial filter
    float spatial_sigma_px = 1.5F;  ///< of the spatial filter
    float spatial_range_sigma = 2;  ///< of the spatial filter, in standard deviations of the noise
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Bennett2005Options& options);

/// Adaptive spatio-temporal accumulation (Bennett and McMillan, SIGGRAPH 2005): each pixel
/// accumulates the same pixel of other frames by a bilateral filter that compares neighbourhoods.
/// A pixel that finds fewer samples than it needs accumulates its spatial neighbours too. Weights
/// depend on the noise of the frames. The same bits for any thread count. Returns nothing if
/// `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> accumulate_samples(
    const DeliveredFrames& frames, const Bennett2005Options& options,
    const ProgressCallback& progress = [](double) { return true; });

/// HDR video of frames whose exposure times alternate (Kang, Uyttendaele, Winder, Szeliski,
/// SIGGRAPH 2003): each frame is merged with the frames before and after it, moved along motion to
/// its time. Weights are inverse variances of the samples, less where the frames contradict each
/// other. Where a frame is saturated, the frames of other exposure times, interpolated along their
/// own motion, take its place; its bound remains. Then the video between the merged frames
/// (frame_video.h). The same bits for any thread count. Returns nothing if the progress callback
/// has stopped it. \throws InputError if the samples are not those of frames.
[[nodiscard]] std::optional<FluxVideo> merge_exposure_times(const BlockTask& block);

/// Options of the method `shahar2011`; docs/decoder_conventional.md has the formulas.
struct Shahar2011Options {
    int octaves = 2;  ///< at most; the last one has a period of one slot
    OctaveOptions octave = {};
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Shahar2011Options& options);

/// Space-time super-resolution from a single video by self-similarity (Shahar, Faktor, Irani, CVPR
/// 2011), in time: the frames as delivered, twice as many in each octave, then interpolated along
/// motion to the slots that are left, and what the frames lack. Frames at uneven distances are
/// interpolated only. Without any sample the video is black. \throws InputError if the samples are
/// not those of frames. Returns nothing if the progress callback has stopped it.
[[nodiscard]] std::optional<FluxVideo> super_resolve_time(const BlockTask& block,
                                                          const Shahar2011Options& options);

/// Options of the method `vbm4d`; docs/decoder_conventional.md has the formulas.
struct Vbm4dOptions {
    int reach_frames = 4;     ///< of a volume, before and after its reference block
    int step_px = 4;          ///< between reference blocks
    int search_px = 5;        ///< search radius of similar volumes
    int max_volumes = 8;      ///< of a group; a power of 2 below is used
    float threshold = 2.7F;   ///< of coefficients in the first stage, in standard deviations
    float max_distance1 = 3;  ///< mean square difference of similar volumes, in noise variances
    float max_distance2 =
        1;  ///< the same in the second stage, where the basic estimate is compared
    int min_confidence = 100;  ///< of the motion of a volume, 0..255
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Vbm4dOptions& options);

/// Collaborative filter of spatio-temporal volumes, after V-BM4D (Maggioni, Boracchi, Foi,
/// Egiazarian, IEEE TIP 21(9), 2012), of frames after a variance-stabilising transform: volumes of
/// blocks along motion, groups of similar volumes, hard thresholding in a 4-D transform, then a
/// Wiener filter with the result as pilot. Frames smaller than a block are not filtered. The same
/// bits for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> filter_volumes(
    const DeliveredFrames& frames, const Vbm4dOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

/// Options of the method `zhang2009`; docs/decoder_conventional.md has the formulas.
struct Zhang2009Options {
    int reach_frames = 5;      ///< of the flow that a patch follows, before and after
    int patch_px = 6;          ///< side of a patch
    int step_px = 3;           ///< between reference patches
    float max_distance = 3;    ///< mean square difference to the reference, in noise variances
    int min_confidence = 100;  ///< of the flow, 0..255
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Zhang2009Options& options);

/// Denoising along optical flow: the patches that the flow leads to are a stack, whose principal
/// components above the noise are kept (Zhang, Vaddadi, Jin, Nayar, CVPR 2009, with the flow of a
/// video for the disparities of views). Frames smaller than a patch are not filtered. The same bits
/// for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> denoise_along_flow(
    const DeliveredFrames& frames, const Zhang2009Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
