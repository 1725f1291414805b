#pragma once

#include <optional>
#include <string>

#include "core/flux_video.h"
#include "decoder/best/collaborative.h"
#include "decoder/best/denoiser.h"

namespace stipple {

class Config;

/// Options of the method `plug_and_play` beside those of `best`.
struct PlugAndPlayOptions {
    std::string network_file;  ///< who reads the options makes `denoiser` of it
    int network_frames = 1;    ///< that the network sees; odd
    DenoiserMaker denoiser = {};
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, PlugAndPlayOptions& options);

/// `decode_by_splitting` with the denoiser of the user. \throws InputError without one, and if a
/// value of its result is not finite or exceeds 10^9; what it throws.
[[nodiscard]] std::optional<FluxVideo> decode_plug_and_play(const SplittingTask& task,
                                                            const CollaborativeOptions& options,
                                                            const PlugAndPlayOptions& own);

}  // namespace stipple
