#include "decoder/conventional/bennett2005.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/conventional/fast_gaussian.h"

namespace stipple {
namespace {

/// Of the neighbourhoods that are compared: along each side, with a sum of 1.
constexpr float kNeighbourhood[] = {1.0F / 16, 4.0F / 16, 6.0F / 16, 4.0F / 16, 1.0F / 16};
constexpr int kReach = 2;

/// Weighted mean over the neighbourhood of each pixel; what lies outside is that of the rim.
void blur(FrameShape shape, std::vector<float>& image) {
    std::vector<float> across(image.size());
    const auto mean = [](int at, int side, const auto& value) {
        float sum = 0;
        for (int k = -kReach; k <= kReach; ++k)
            sum += kNeighbourhood[k + kReach] * value(std::clamp(at + k, 0, side - 1));
        return sum;
    };
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            across[row_major(row, col, shape.cols)] =
                mean(col, shape.cols, [&](int c) { return image[row_major(row, c, shape.cols)]; });
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            image[row_major(row, col, shape.cols)] =
                mean(row, shape.rows, [&](int r) { return across[row_major(r, col, shape.cols)]; });
}

class Accumulation {
  public:
    Accumulation(const DeliveredFrames& frames, const Bennett2005Options& options)
        : frames_(frames),
          options_(options),
          shape_(frames.light.shape()),
          temporal_(frames.light.slots(), shape_),
          samples_(frames.light.slots(), {shape_.rows, shape_.cols, 1}) {}

    void accumulate_in_time(int frame) {
        const auto own = frames_.light.frame(frame);
        const auto sum = temporal_.frame(frame);
        const auto samples = samples_.frame(frame);
        std::ranges::copy(own, sum.begin());
        std::ranges::fill(samples, 1.0F);
        const int last = std::min(frame + options_.reach_frames, frames_.light.slots() - 1);
        for (int other = std::max(frame - options_.reach_frames, 0); other <= last; ++other) {
            if (other == frame) continue;
            const std::vector<float> weight = weights(frame, other);
            const auto light = frames_.light.frame(other);
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += weight[i % weight.size()] * light[i];
            for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += weight[i];
        }
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= samples[i % samples.size()];
    }

    /// Adds spatial neighbours to pixels that have found too few samples.
    void accumulate_in_space(int frame, FluxVideo& result) const {
        for (int row = 0; row < shape_.rows; ++row)
            for (int col = 0; col < shape_.cols; ++col) write_pixel(frame, row, col, result);
    }

  private:
    /// g(D) of each pixel, D the squared difference of the neighbourhoods over its expected value.
    [[nodiscard]] std::vector<float> weights(int frame, int other) const {
        const auto a = frames_.light.frame(frame);
        const auto b = frames_.light.frame(other);
        std::vector<float> square(shape_.pixels());
        std::vector<float> expected(shape_.pixels());
        for (std::size_t i = 0; i < a.size(); ++i) {
            const float difference = a[i] - b[i];
            square[i % square.size()] += difference * difference;
            expected[i % square.size()] += 2 * frames_.noise.variance((a[i] + b[i]) / 2);
        }
        blur(shape_, square);
        blur(shape_, expected);
        const float scale = 1 / (2 * options_.range_sigma * options_.range_sigma);
        for (std::size_t i = 0; i < square.size(); ++i) {
            const float excess = std::max(square[i] / expected[i] - 1, 0.0F);
            square[i] = fast_gaussian(scale * excess * excess);
        }
        return square;
    }

    /// Samples whose mean has the noise that is aimed at.
    [[nodiscard]] float needed(float light, float variance) const {
        const float target = options_.target_noise * std::max(light, 0.0F);
        const auto most = static_cast<float>(options_.max_samples);
        return variance < most * target * target ? variance / (target * target) : most;
    }

    void write_pixel(int frame, int row, int col, FluxVideo& result) const {
        const std::size_t pixel = row_major(row, col, shape_.cols);
        const auto light = temporal_.frame(frame);
        const auto samples = samples_.frame(frame);
        float mean = 0;
        for (std::size_t i = pixel; i < light.size(); i += shape_.pixels())
            mean += light[i] / static_cast<float>(shape_.planes);
        const float missing = needed(mean, frames_.noise.variance(mean)) - samples[pixel];
        for (int plane = 0; plane < shape_.planes; ++plane)
            result.plane(frame, plane)(row, col) = temporal_.plane(frame, plane)(row, col);
        if (missing <= 0 || options_.radius_px == 0) return;
        add_neighbours({frame, row, col}, missing, result);
    }

    struct Place {
        int frame;
        int row;
        int col;
    };

    void add_neighbours(const Place& at, float missing, FluxVideo& result) const {
        std::vector<float> sums(index(shape_.planes));
        float found = 0;
        const auto samples = samples_.plane(at.frame, 0);
        const int radius = options_.radius_px;
        for (int r = std::max(at.row - radius, 0); r <= std::min(at.row + radius, shape_.rows - 1);
             ++r)
            for (int c = std::max(at.col - radius, 0);
                 c <= std::min(at.col + radius, shape_.cols - 1); ++c) {
                if (r == at.row && c == at.col) continue;
                const float weight = samples(r, c) * spatial_weight(at, r, c);
                found += weight;
                for (int plane = 0; plane < shape_.planes; ++plane)
                    sums[index(plane)] += weight * temporal_.plane(at.frame, plane)(r, c);
            }
        if (!(found > 0)) return;
        const float share = std::min(missing / found, 1.0F);
        const float own = samples(at.row, at.col);
        for (int plane = 0; plane < shape_.planes; ++plane) {
            float& light = result.plane(at.frame, plane)(at.row, at.col);
            light = (own * light + share * sums[index(plane)]) / (own + share * found);
        }
    }

    [[nodiscard]] float spatial_weight(const Place& at, int row, int col) const {
        float square = 0;
        float expected = 0;
        const float shares = 1 / samples_.plane(at.frame, 0)(at.row, at.col) +
                             1 / samples_.plane(at.frame, 0)(row, col);
        for (int plane = 0; plane < shape_.planes; ++plane) {
            const auto light = temporal_.plane(at.frame, plane);
            const float a = light(at.row, at.col);
            const float b = light(row, col);
            square += (a - b) * (a - b);
            expected += frames_.noise.variance((a + b) / 2) * shares;
        }
        const auto down = static_cast<float>(row - at.row);
        const auto right = static_cast<float>(col - at.col);
        const auto half = [](float sigma) { return 1 / (2 * sigma * sigma); };
        return fast_gaussian(half(options_.spatial_sigma_px) * (down * down + right * right)) *
               fast_gaussian(half(options_.spatial_range_sigma) * (square / expected));
    }

    const DeliveredFrames& frames_;
    const Bennett2005Options& options_;
    FrameShape shape_;
    FluxVideo temporal_;
    FluxVideo samples_;  ///< sum of the weights, the own one is 1
};

}  // namespace

std::optional<FluxVideo> accumulate_samples(const DeliveredFrames& frames,
                                            const Bennett2005Options& options,
                                            const ProgressCallback& progress) {
    Accumulation accumulation(frames, options);
    const int count = frames.light.slots();
    parallel_for(0, count, [&](int frame) { accumulation.accumulate_in_time(frame); });
    if (!progress(0.5)) return {};
    FluxVideo result(count, frames.light.shape());
    parallel_for(0, count, [&](int frame) { accumulation.accumulate_in_space(frame, result); });
    if (!progress(1)) return {};
    return result;
}

void read_options(Config& config, Bennett2005Options& options) {
    const KeyReader read(config);
    read({"reach_frames", {0, 32}, "frames", "frames before and after that are accumulated"},
         options.reach_frames);
    read({"range_sigma", {1e-3, 1e3}, "", "sigma of the excess distance of neighbourhoods"},
         options.range_sigma);
    read({"target_noise", {1e-4, 1}, "", "noise that a pixel is to have, relative to its light"},
         options.target_noise);
    read({"max_samples", {1, 1000}, "", "most samples that a pixel needs"}, options.max_samples);
    read({"radius_px", {0, 16}, "pixels", "radius of the spatial filter"}, options.radius_px);
    read({"spatial_sigma_px", {0.1, 16}, "pixels", "sigma of the spatial filter"},
         options.spatial_sigma_px);
    read({"spatial_range_sigma", {1e-3, 1e3}, "", "sigma of differences, in their noise"},
         options.spatial_range_sigma);
}

}  // namespace stipple
