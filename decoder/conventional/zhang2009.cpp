#include "decoder/conventional/conventional_methods.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/key_reader.h"
#include "decoder/conventional/block_paths.h"
#include "decoder/conventional/block_sums.h"
#include "decoder/conventional/patch_stack.h"
#include "decoder/conventional/stabilised_frames.h"

namespace stipple {
namespace {

/// Appends the patches at these places, order (patch, row, col).
void append_patches(const FluxVideo& video, int plane, const std::vector<BlockPlace>& places,
                    int side, std::vector<float>& values) {
    for (const BlockPlace& place : places)
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col)
                values.push_back(video.plane(place.frame, plane)(place.row + row, place.col + col));
}

/// Drops the places whose patches differ from the reference by more than noise explains.
void keep_similar(const FluxVideo& video, const BlockPlace& reference, int side, float limit,
                  std::vector<BlockPlace>& path) {
    const auto differs = [&](const BlockPlace& place) {
        float sum = 0;
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col) {
                const float d =
                    video.plane(place.frame, 0)(place.row + row, place.col + col) -
                    video.plane(reference.frame, 0)(reference.row + row, reference.col + col);
                sum += d * d;
            }
        return sum > limit * static_cast<float>(side * side);
    };
    std::erase_if(path, differs);
}

}  // namespace

std::optional<FluxVideo> denoise_along_flow(const DeliveredFrames& frames,
                                            const Zhang2009Options& options,
                                            const ProgressCallback& progress) {
    const FrameShape shape = frames.light.shape();
    const int side = options.patch_px;
    if (std::min(shape.rows, shape.cols) < side) return frames.light;
    const StabilisedFrames noisy = stabilised(frames);
    const BlockPaths paths(frames.light, side);
    const auto filtered = [&](const BlockPlace& reference) {
        FilteredBlocks result;
        paths.follow(reference, options.reach_frames,
                     static_cast<std::uint8_t>(options.min_confidence), result.places);
        keep_similar(noisy.values, reference, side,
                     options.max_distance * noisy.sigma * noisy.sigma, result.places);
        for (int plane = 0; plane < shape.planes; ++plane) {
            const std::size_t begin = result.values.size();
            append_patches(noisy.values, plane, result.places, side, result.values);
            const float squares =
                filter_patch_stack(std::span(result.values).subspan(begin),
                                   static_cast<int>(result.places.size()), noisy.sigma);
            result.weights.push_back(static_cast<float>(result.places.size()) / squares);
        }
        return result;
    };
    const auto result = filter_blocks(
        {frames.light.slots(), shape, side, std::min(options.step_px, side)}, filtered, progress);
    if (!result) return {};
    return restored(*result, noisy.scale, frames.noise);
}

void read_options(Config& config, Zhang2009Options& options) {
    const KeyReader read(config);
    read({"reach_frames", {0, 16}, "frames", "reach of the flow that a patch follows, either way"},
         options.reach_frames);
    read({"patch_px", {2, 16}, "pixels", "side of a patch"}, options.patch_px);
    read({"step_px", {1, 16}, "pixels", "stride of reference patches; patch_px at most counts"},
         options.step_px);
    read({"max_distance", {0, 1e4}, "", "mean square to the reference, in noise variances"},
         options.max_distance);
    read({"min_confidence", {0, 255}, "", "least confidence of the flow"}, options.min_confidence);
}

}  // namespace stipple
