#include "decoder/reddy2011/sparse_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

/// ||a_k||^2 of each exposure, inverted; 0 at voxels that end none.
std::vector<float> inverse_norms(const Measurements& m) {
    std::vector<float> norms(m.voxels());
    const std::vector<float> ones = m.weight.empty() ? std::vector<float>(m.voxels(), 1) : m.weight;
    sample(m, ones, norms);
    for (float& norm : norms) norm = norm > 0 ? 1 / norm : 0;
    return norms;
}

/// Calls body(voxel) for all voxels, slot by slot in parallel.
template <typename Body>
void for_each_voxel(const FluxVideo& video, const Body& body) {
    const std::size_t sites = video.shape().sites();
    parallel_for(0, video.slots(), [&](int slot) {
        for (std::size_t i = index(slot) * sites; i < (index(slot) + 1) * sites; ++i) body(i);
    });
}

/// lambda of an iteration: falls geometrically in the first half.
float weight_of(const SparseFramesTask& task, int iteration) {
    const int steps = task.iterations / 2;
    float weight = std::max(task.first_weight, task.wavelet_weight);
    // Eight steps of equal factors: square roots have the same bits everywhere.
    const float factor =
        std::sqrt(std::sqrt(std::sqrt(task.wavelet_weight / std::max(weight, 1e-30F))));
    for (int i = 0; i < std::min(8, iteration * 8 / std::max(steps, 1)); ++i) weight *= factor;
    return std::max(weight, task.wavelet_weight);
}

}  // namespace

SparseFramesSolver::SparseFramesSolver(const Measurements& measurements, int max_levels)
    : measurements_(measurements),
      wavelet_(measurements.shape, max_levels),
      inverse_norms_(inverse_norms(measurements)),
      residuals_(measurements.voxels()) {}

void SparseFramesSolver::data_gradient(const FluxVideo& x, std::span<float> gradient) {
    sample(measurements_, x.data(), residuals_);
    for_each_voxel(x, [&](std::size_t i) {
        const float excess = residuals_[i] - measurements_.sum[i];
        const bool explained =
            (measurements_.state[i] & Measurements::kSaturated) != 0 && excess > 0;
        residuals_[i] = explained ? 0 : excess * inverse_norms_[i];
    });
    spread(measurements_, residuals_, gradient);
}

void SparseFramesSolver::minimise(const SparseFramesTask& task, FluxVideo& x) {
    const bool linked = task.links != nullptr && task.flow_weight > 0;
    // The data term has the norm 1.
    const float step = 1 / (1 + (linked ? task.flow_weight * task.links->squared_norm_bound() : 0));
    FluxVideo ahead = x;     // the extrapolated point
    FluxVideo previous = x;  // then its successor
    std::vector<float> gradient(x.voxels());
    float t = 1;
    for (int i = 0; i < task.iterations; ++i) {
        data_gradient(ahead, gradient);
        if (linked) task.links->add_gradient(ahead, task.flow_weight, gradient);
        const float threshold = step * weight_of(task, i);
        const float next_t = (1 + std::sqrt(1 + 4 * t * t)) / 2;
        const float momentum = (t - 1) / next_t;
        t = next_t;
        std::swap(x, previous);
        for_each_voxel(x,
                       [&](std::size_t v) { x.data()[v] = ahead.data()[v] - step * gradient[v]; });
        const int planes = x.shape().planes;
        parallel_for(0, x.slots() * planes, [&](int frame) {
            const PlaneView<float> plane = x.plane(frame / planes, frame % planes);
            wavelet_.forward(plane);
            wavelet_.shrink(plane, threshold);
            wavelet_.inverse(plane);
        });
        for_each_voxel(x, [&](std::size_t v) {
            ahead.data()[v] = x.data()[v] + momentum * (x.data()[v] - previous.data()[v]);
        });
        if (!task.keep_going(i + 1)) return;
    }
}

}  // namespace stipple
