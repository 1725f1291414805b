#include "decoder/rivals/zhang2009.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "core/key_reader.h"
#include "decoder/rivals/block_paths.h"
#include "decoder/rivals/block_sums.h"
#include "decoder/rivals/stabilised_frames.h"

namespace stipple {
namespace {

/// Patches by rows.
using Stack = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Stack load(const FluxVideo& video, int plane, const std::vector<BlockPlace>& places, int side) {
    Stack stack(static_cast<int>(places.size()), side * side);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col)
                stack(static_cast<int>(i), row * side + col) =
                    video.plane(places[i].frame, plane)(places[i].row + row, places[i].col + col);
    return stack;
}

/// Keeps the mean patch and the principal components whose variance exceeds that of noise.
class StackFilter {
  public:
    explicit StackFilter(float sigma) : variance_(sigma * sigma) {}

    /// In place. Returns the sum of the squared factors of its components, the mean included.
    [[nodiscard]] float filter(Stack& stack) const {
        const auto patches = static_cast<float>(stack.rows());
        const auto values = static_cast<float>(stack.cols());
        if (stack.rows() == 1) return 1;
        const Eigen::RowVectorXf mean = stack.colwise().sum() / patches;
        stack.rowwise() -= mean;
        const Eigen::SelfAdjointEigenSolver<Stack> solver(stack * stack.transpose());
        // The largest eigenvalue of noise (Marchenko and Pastur 1967).
        const float root = std::sqrt(values) + std::sqrt(patches);
        const float limit = variance_ * root * root;
        Stack kept = Stack::Zero(stack.rows(), stack.rows());
        float squares = 1;
        for (int k = 0; k < stack.rows(); ++k) {
            const float power = solver.eigenvalues()(k);
            if (!(power > limit)) continue;
            const float factor = (power - variance_ * values) / power;
            kept +=
                factor * solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
            squares += factor * factor;
        }
        stack = (kept * stack).eval();
        stack.rowwise() += mean;
        return squares;
    }

  private:
    float variance_;
};

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
    const StackFilter filter(noisy.sigma);
    const auto filtered = [&](const BlockPlace& reference) {
        FilteredBlocks result;
        paths.follow(reference, options.reach_frames,
                     static_cast<std::uint8_t>(options.min_confidence), result.places);
        keep_similar(noisy.values, reference, side,
                     options.max_distance * noisy.sigma * noisy.sigma, result.places);
        for (int plane = 0; plane < shape.planes; ++plane) {
            Stack stack = load(noisy.values, plane, result.places, side);
            const float squares = filter.filter(stack);
            result.weights.push_back(static_cast<float>(stack.rows()) / squares);
            result.values.insert(result.values.end(), stack.data(), stack.data() + stack.size());
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
