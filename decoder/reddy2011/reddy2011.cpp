#include "decoder/reddy2011/reddy2011.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "decoder/measurements.h"
#include "decoder/mosaic_hues.h"
#include "decoder/motion/motion.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/reddy2011/sparse_frames.h"

namespace stipple {
namespace {

/// Copies planes into the top left corner of larger or smaller ones.
template <typename Value>
void copy_frames(std::span<const Value> from, FrameShape from_shape, std::span<Value> to,
                 FrameShape to_shape) {
    const int rows = std::min(from_shape.rows, to_shape.rows);
    const int cols = std::min(from_shape.cols, to_shape.cols);
    const std::size_t planes = from.size() / from_shape.pixels();
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (int row = 0; row < rows; ++row)
            std::copy_n(
                from.begin() + static_cast<std::ptrdiff_t>(plane * from_shape.pixels() +
                                                           row_major(row, 0, from_shape.cols)),
                cols,
                to.begin() + static_cast<std::ptrdiff_t>(plane * to_shape.pixels() +
                                                         row_major(row, 0, to_shape.cols)));
}

/// The same samples in larger frames, whose further pixels are unobserved.
Measurements padded(const Measurements& m, FrameShape shape) {
    const std::size_t voxels = index(m.slots) * shape.sites();
    Measurements result{.slots = m.slots,
                        .shape = shape,
                        .state = std::vector<std::uint8_t>(voxels),
                        .sum = std::vector<float>(voxels),
                        .variance = {},
                        .interleaved = m.interleaved,
                        .mosaic = m.mosaic};
    copy_frames<std::uint8_t>(m.state, m.shape, result.state, shape);
    copy_frames<float>(m.sum, m.shape, result.sum, shape);
    if (m.weight.empty()) return result;
    result.weight.assign(voxels, 1);
    copy_frames<float>(m.weight, m.shape, result.weight, shape);
    return result;
}

/// Frames of another shape; further pixels repeat the last ones.
FluxVideo reshaped(const FluxVideo& video, FrameShape shape) {
    FluxVideo result(video.slots(), shape);
    copy_frames<float>(video.data(), video.shape(), result.data(), shape);
    const int rows = std::min(video.shape().rows, shape.rows);
    const int cols = std::min(video.shape().cols, shape.cols);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int p = 0; p < shape.planes; ++p) {
            const PlaneView<float> plane = result.plane(slot, p);
            for (int row = 0; row < rows; ++row)
                std::ranges::fill(plane.row(row).subspan(index(cols)), plane(row, cols - 1));
            for (int row = rows; row < shape.rows; ++row)
                std::ranges::copy(plane.row(rows - 1), plane.row(row).begin());
        }
    return result;
}

/// The stages on one block of padded frames.
class Decoder {
  public:
    Decoder(const Measurements& measurements, const Reddy2011Options& options,
            const ProgressCallback& progress)
        : options_(options), progress_(progress), solver_(measurements, options.levels) {
        total_ = options.first_iterations + options.rounds * (kFlow + options.iterations);
    }

    void without_flow(FluxVideo& x) {
        minimise({.iterations = options_.first_iterations,
                  .wavelet_weight = options_.wavelet_weight,
                  .first_weight = options_.first_weight},
                 x);
    }

    void along_flow(FluxVideo& x, bool first) {
        const FlowLinks links(estimate_motion(x, {.coarse = first}), x.shape(),
                              options_.min_confidence);
        done_ += kFlow;
        minimise({.iterations = options_.iterations,
                  .wavelet_weight = options_.wavelet_weight,
                  .flow_weight = options_.flow_weight,
                  .links = &links},
                 x);
    }

    [[nodiscard]] bool stopped() const { return stopped_; }

  private:
    static constexpr int kFlow = 8;  ///< iterations that take as long as a flow

    void minimise(SparseFramesTask task, FluxVideo& x) {
        task.keep_going = [&](int iterations) {
            stopped_ = !progress_(static_cast<double>(done_ + iterations) / (total_ + 1));
            return !stopped_;
        };
        solver_.minimise(task, x);
        done_ += task.iterations;
    }

    const Reddy2011Options& options_;
    const ProgressCallback& progress_;
    SparseFramesSolver solver_;
    int total_;
    int done_ = 0;
    bool stopped_ = false;
};

}  // namespace

std::optional<FluxVideo> decode_reddy2011(const Measurements& measurements,
                                          const Reddy2011Options& options,
                                          const StageObserver& observer,
                                          const ProgressCallback& progress) {
    if (measurements.mosaic)
        return decode_by_hue(measurements, observer, [&](const auto& mean, const auto& told) {
            return decode_reddy2011(mean, options, told, progress);
        });
    const FrameShape shape = measurements.shape;
    const FrameShape whole = WaveletTransform::padded_shape(shape, options.levels);
    const bool pad = whole != shape;
    FluxVideo x = nearest_samples(measurements);
    if (pad) x = reshaped(x, whole);
    const auto tell = [&](const std::string& stage) {
        if (observer.finished) observer.finished(stage, pad ? reshaped(x, shape) : x);
    };
    tell("start");
    const Measurements larger = pad ? padded(measurements, whole) : Measurements{};
    Decoder decoder(pad ? larger : measurements, options, progress);
    decoder.without_flow(x);
    if (decoder.stopped()) return {};
    tell("without_flow");
    const bool can_move = std::min(shape.rows, shape.cols) >= kMinMotionSide;
    for (int round = 0; can_move && round < options.rounds; ++round) {
        decoder.along_flow(x, round == 0);
        if (decoder.stopped()) return {};
        tell(fmt::format("round{}", round + 1));
    }
    if (pad) x = reshaped(x, shape);
    return x;
}

void read_options(Config& config, Reddy2011Options& options) {
    constexpr KeyRange kIterations{0, 10000};
    constexpr KeyRange kWeight{0, 1e4};
    const KeyReader read(config);
    read({"levels", {0, 12}, "", "max levels of the wavelet transform"}, options.levels);
    read({"wavelet_weight", kWeight, "flux", "lambda: weight of the wavelet coefficients"},
         options.wavelet_weight);
    read({"first_weight", kWeight, "flux", "lambda of the first iteration without flow"},
         options.first_weight);
    read({"flow_weight", kWeight, "", "beta: weight of brightness constancy"}, options.flow_weight);
    read({"min_confidence", {0, 1}, "", "min confidence of a consistent flow"},
         options.min_confidence);
    read({"first_iterations", kIterations, "", "iterations without flow"},
         options.first_iterations);
    read({"rounds", {0, 100}, "", "rounds of flow and minimisation along it"}, options.rounds);
    read({"iterations", kIterations, "", "iterations in each round"}, options.iterations);
}

}  // namespace stipple
