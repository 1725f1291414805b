#include "decoder/plug_and_play/plug_and_play.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/config.h"
#include "core/error.h"

namespace stipple {
namespace {

constexpr float kMaxValue = 1e9F;  // its square, light, is far from the largest float

/// \throws InputError naming the first value that no light can have.
void check_values(const FluxVideo& video) {
    const auto bad = std::ranges::find_if(
        video.data(), [](float value) { return !(std::abs(value) <= kMaxValue); });
    if (bad == video.data().end()) return;
    const auto at = static_cast<std::size_t>(bad - video.data().begin());
    const FrameShape shape = video.shape();
    const std::size_t pixel = at % shape.pixels();
    const auto cols = static_cast<std::size_t>(shape.cols);
    throw InputError("denoiser",
                     fmt::format("its result has the value {} in slot {}, row {}, column {} of the "
                                 "block; values are finite, at most 1e9",
                                 *bad, at / shape.sites(), pixel / cols, pixel % cols));
}

}  // namespace

void read_options(Config& config, PlugAndPlayOptions& options) {
    const KeyReader read(config);
    read({.name = "denoiser", .text = "ONNX file of a network that takes out noise"},
         options.network_file);
    read({"denoiser_frames", {1, 31}, "frames", "frames that it sees; odd, the middle one counts"},
         options.network_frames);
    if (options.network_frames % 2 == 0)
        throw InputError(
            config.where("denoiser_frames"),
            fmt::format("{} is even; the network gives the middle frame of an odd number",
                        options.network_frames));
}

std::optional<FluxVideo> decode_plug_and_play(const SplittingTask& task,
                                              const CollaborativeOptions& options,
                                              const PlugAndPlayOptions& own) {
    if (!own.denoiser)
        throw InputError("plug_and_play", "has no denoiser; give the file of a network, " +
                                              Parameter{"decoder.denoiser", "net.onnx"});
    return decode_by_splitting(task, options,
                               [&](const CollaborativeOptions& of_block, bool mosaic) -> Denoiser {
                                   return [denoise = own.denoiser(of_block, mosaic)](
                                              const DenoiserInput& input, FluxVideo& result) {
                                       denoise(input, result);
                                       check_values(result);
                                   };
                               });
}

}  // namespace stipple
