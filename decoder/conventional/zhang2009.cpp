#include "decoder/conventional/zhang2009.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "decoder/conventional/block_filter.h"
#include "decoder/conventional/frame_decoding.h"

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

/// Patches by rows.
using Stack = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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

float filter_patch_stack(std::span<float> stack, int patches, float sigma) {
    if (patches == 1) return 1;
    const auto values = static_cast<int>(std::ssize(stack)) / patches;
    Stack x = Eigen::Map<const Stack>(stack.data(), patches, values);
    const Eigen::RowVectorXf mean = x.colwise().sum() / static_cast<float>(patches);
    x.rowwise() -= mean;
    const Eigen::SelfAdjointEigenSolver<Stack> solver(x * x.transpose());
    const float variance = sigma * sigma;
    const float root =
        std::sqrt(static_cast<float>(values)) + std::sqrt(static_cast<float>(patches));
    const float limit = variance * root * root;
    Stack kept = Stack::Zero(patches, patches);
    float squares = 1;
    for (int k = 0; k < patches; ++k) {
        const float power = solver.eigenvalues()(k);
        if (!(power > limit)) continue;
        const float factor = (power - variance * static_cast<float>(values)) / power;
        kept += factor * solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
        squares += factor * factor;
    }
    x = (kept * x).eval();
    x.rowwise() += mean;
    std::copy_n(x.data(), x.size(), stack.begin());
    return squares;
}

}  // namespace stipple
