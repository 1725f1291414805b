#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/flux_video.h"
#include "decoder/progress_callback.h"

namespace stipple {

class Config;
struct Calibration;
struct DecodeOptions;
struct Measurements;
struct StageObserver;

enum class DecodeMethod {
    kNaive,      ///< each pixel holds its nearest samples; no model of the scene
    kFast,       ///< motion-compensated total variation
    kBest,       ///< collaborative filter of similar patches
    kPortz2013,  ///< the method of the paper, in two stages
};

/// A block of the video, to be decoded.
struct BlockTask {
    Measurements& measurements;  ///< a method may change them
    const Calibration& calibration;
    const DecodeOptions& options;
    const ProgressCallback& progress;
    const StageObserver& observer;
};

/// All that the decoder knows of a method.
struct NamedDecodeMethod {
    std::string_view name;
    DecodeMethod method;
    std::string_view text;        ///< what it is and costs, for people
    std::int64_t max_tile_sites;  ///< larger frames are decoded in tiles
    std::uint64_t voxel_bytes;    ///< memory of the estimate and all that belongs to it
    /// The keys of docs/decoder_options.md. \throws InputError as Config.
    void (*read_options)(Config& config, DecodeOptions& options);
    /// The result may be slightly negative. Nothing if the progress callback has stopped it.
    std::optional<FluxVideo> (*decode)(const BlockTask& block);
};

/// Every method there is, from the simplest on.
[[nodiscard]] std::span<const NamedDecodeMethod> decode_methods();

[[nodiscard]] const NamedDecodeMethod& named(DecodeMethod method);

/// \throws InputError listing the names of `decode_methods`.
[[nodiscard]] DecodeMethod decode_method_from_name(std::string_view name);

}  // namespace stipple
