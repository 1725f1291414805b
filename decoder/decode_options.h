#pragma once

#include <span>
#include <string_view>

#include "core/config.h"
#include "decoder/collaborative.h"
#include "decoder/motion_tv.h"
#include "decoder/portz2013.h"
#include "decoder/stage_observer.h"

namespace stipple {

enum class DecodeMethod {
    kNaive,      ///< each pixel holds its nearest samples; no model of the scene
    kFast,       ///< motion-compensated total variation
    kBest,       ///< collaborative filter of similar blocks
    kPortz2013,  ///< the method of the paper, in two stages
};

struct NamedDecodeMethod {
    std::string_view name;
    DecodeMethod method;
};

/// Every method there is, from the simplest on.
[[nodiscard]] std::span<const NamedDecodeMethod> decode_methods();

/// \throws InputError listing the names of `decode_methods`.
[[nodiscard]] DecodeMethod decode_method_from_name(std::string_view name);

/// A method and the options of each; those of the others have no effect.
struct DecodeOptions {
    DecodeMethod method = DecodeMethod::kBest;
    MotionTvOptions fast = {};
    CollaborativeOptions best = {};
    Portz2013Options portz2013 = {};
    StageSink stages = {};
};

/// The method with the options of `config`, whose keys are those of docs/decoder_options.md for
/// this method. \throws InputError for an unknown key, a wrong type or a value out of range.
[[nodiscard]] DecodeOptions read_decode_options(DecodeMethod method, Config& config);

}  // namespace stipple
