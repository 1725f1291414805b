#include "decoder/mosaic_hues.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"

namespace stipple {
namespace {

constexpr std::size_t kColours = 3;

/// Each colour of a voxel over the mean of the three. Colours below kDark are noise: as kDark.
FluxVideo hues_of(FluxVideo colours) {
    constexpr float kDark = 0.02F;
    const std::size_t pixels = colours.shape().pixels();
    parallel_for(0, colours.slots(), [&](int slot) {
        const auto frame = colours.frame(slot);
        for (std::size_t i = 0; i < pixels; ++i) {
            float sum = 0;
            for (std::size_t p = 0; p < kColours; ++p)
                sum += frame[p * pixels + i] = std::max(frame[p * pixels + i], kDark);
            for (std::size_t p = 0; p < kColours; ++p) frame[p * pixels + i] *= kColours / sum;
        }
    });
    return colours;
}

/// The samples as those of the mean: the weight of a voxel is that of its exposure times its hue.
Measurements mean_measurements(const Measurements& m, const FluxVideo& hues) {
    FrameShape shape = m.shape;
    shape.planes = 1;
    const std::size_t pixels = shape.pixels();
    const std::size_t voxels = index(m.slots) * pixels;
    Measurements mean{.slots = m.slots,
                      .shape = shape,
                      .state = std::vector<std::uint8_t>(voxels),
                      .sum = std::vector<float>(voxels),
                      .variance = std::vector<float>(m.variance.empty() ? 0 : voxels),
                      .interleaved = m.interleaved,
                      .weight = std::vector<float>(voxels, 1)};
    parallel_for(0, m.slots, [&](int slot) {
        for (std::size_t site = 0; site < kColours * pixels; ++site) {
            const std::size_t from = index(slot) * kColours * pixels + site;
            if (m.state[from] == 0) continue;
            const std::size_t to = index(slot) * pixels + site % pixels;
            mean.state[to] = m.state[from];
            mean.sum[to] = m.sum[from];
            if (!m.variance.empty()) mean.variance[to] = m.variance[from];
            mean.weight[to] = m.weight_at(from) * hues.data()[from];
        }
    });
    return mean;
}

FluxVideo coloured(const FluxVideo& mean, FluxVideo hues) {
    const std::size_t pixels = mean.shape().pixels();
    parallel_for(0, mean.slots(), [&](int slot) {
        const auto frame = hues.frame(slot);
        for (std::size_t i = 0; i < frame.size(); ++i) frame[i] *= mean.frame(slot)[i % pixels];
    });
    return hues;
}

}  // namespace

std::optional<FluxVideo> decode_by_hue(const Measurements& measurements,
                                       const StageObserver& observer, const PlaneDecoder& decode) {
    FluxVideo hues = hues_of(nearest_samples(measurements));
    StageObserver in_colour{.finished = {}, .iterated = observer.iterated};
    if (observer.finished)
        in_colour.finished = [&](std::string_view stage, const FluxVideo& mean) {
            observer.finished(stage, coloured(mean, hues));
        };
    const auto mean = decode(mean_measurements(measurements, hues), in_colour);
    if (!mean) return {};
    return coloured(*mean, std::move(hues));
}

}  // namespace stipple
