#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/flux_video.h"
#include "decoder/best/collaborative.h"

namespace stipple {

class Config;

/// What a refiner gets of a plane of a slot: its inputs, order (input, row, col)
/// (refinement_inputs.h). It writes all of `refined`, v of each pixel without its errors, order
/// (row, col).
struct RefinerInput {
    std::span<const float> inputs;
    int rows;
    int cols;
};
/// Called in the thread that decodes, for one plane after another. What it throws ends the
/// decoding.
using Refiner = std::function<void(const RefinerInput& input, std::span<float> refined)>;

/// Options of the methods `learned` and `learned_fast` beside those of `best` and `fast`.
struct LearnedOptions {
    std::string model_file;  ///< who reads the options makes `refine` of it; empty: that of Stipple
    Refiner refine = {};
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, LearnedOptions& options);

/// The refiner of a file of weights: RefinementNetwork, whose metadata has `inputs` =
/// kRefinementInputsName. It keeps the estimate where a sample without light has less noise than
/// 0.45 or more than 62 electrons in the scale of light (refinement_inputs.h), for which it is not
/// trained, unless there is none (SampleNoise::none). \throws InputError as
/// RefinementNetwork::read, and if the network is made for other inputs.
[[nodiscard]] Refiner refinement_of(const std::string& file);

/// The estimate of `best`, refined: an error of it in the square root of light is predicted from
/// the estimate, its neighbours along motion and the samples, and taken away. Returns nothing if
/// the progress has stopped it. \throws InputError without a refiner, and if a value of its result
/// is not finite; what it throws. Precondition: one sensor.
[[nodiscard]] std::optional<FluxVideo> decode_learned(const SplittingTask& task,
                                                      const CollaborativeOptions& options,
                                                      const Refiner& refine);

/// The same with the estimate of `fast`.
[[nodiscard]] std::optional<FluxVideo> decode_learned_fast(const SplittingTask& task,
                                                           const MotionTvOptions& options,
                                                           const Refiner& refine);

}  // namespace stipple
