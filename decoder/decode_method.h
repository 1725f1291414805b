#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/stage_observer.h"

namespace stipple {

class Config;
class ExposureSchedule;
struct Calibration;
struct DecodeOptions;
struct Measurements;

enum class DecodeMethod {
    kNaive,        ///< each pixel holds its nearest samples; no model of the scene
    kLive,         ///< residuals of samples blurred in space, for a picture while filming
    kFast,         ///< motion-compensated total variation
    kBest,         ///< collaborative filter of similar patches
    kLearnedFast,  ///< the estimate of fast, refined by a network
    kLearned,      ///< the estimate of best, refined by a network
    kPlugAndPlay,  ///< best, with a denoiser of the user
    kPortz2013,    ///< the method of the paper, in two stages
    // Of other coded cameras.
    kReddy2011,   ///< wavelets and brightness constancy
    kHitomi2011,  ///< patches of a learned dictionary
    // Of conventional cameras; see conventional/.
    kInterpolated,  ///< frames as delivered
    kBennett2005,   ///< adaptive spatio-temporal accumulation
    kZhang2009,     ///< principal components of patches along optical flow
    kVbm4d,         ///< collaborative filter of volumes along motion
    kShahar2011,    ///< temporal super-resolution by self-similarity
    kKang2003,      ///< frames of alternating exposure times, merged along motion
};

/// A block of the video and the context of its decoding.
struct BlockTask {
    Measurements& measurements;  ///< a method may change them
    const Calibration& calibration;
    const DecodeOptions& options;
    const ProgressCallback& progress;
    const StageObserver& observer;
};

/// A row of the table of methods.
struct NamedDecodeMethod {
    std::string_view name;
    DecodeMethod method;
    bool joins_sensors;           ///< it decodes the streams of several sensors to one video
    bool has_stages;              ///< it calls the StageObserver of the block
    std::string_view text;        ///< description and cost, for users
    std::int64_t max_tile_sites;  ///< larger frames are decoded in tiles
    std::uint64_t voxel_bytes;    ///< memory of all arrays of the method, bytes a voxel
    double voxel_us;              ///< time of a core for a voxel, about (expected_cost)
    /// The keys of `stipple list keys decoder`. \throws InputError as Config.
    void (*read_options)(Config& config, DecodeOptions& options);
    /// The result may be slightly negative. Returns nothing if the progress callback has stopped
    /// it.
    std::optional<FluxVideo> (*decode)(const BlockTask& block);
    /// If given, \throws InputError that names `stream` and the method, for a schedule that the
    /// method does not take.
    void (*check_schedule)(const ExposureSchedule& schedule, std::string_view stream,
                           std::string_view method) = nullptr;
};

/// All methods, the simplest first.
[[nodiscard]] std::span<const NamedDecodeMethod> decode_methods();

[[nodiscard]] const NamedDecodeMethod& named(DecodeMethod method);

/// \throws InputError listing the names of `decode_methods`.
[[nodiscard]] DecodeMethod decode_method_from_name(std::string_view name);

}  // namespace stipple
