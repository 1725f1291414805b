#include "decoder/conventional/shahar2011.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/conventional/fast_gaussian.h"
#include "decoder/motion/frame_interpolation.h"

namespace stipple {
namespace {

/// Which frames are compared: `target` of the frames, `example` of the coarse ones, both relative
/// to the frame; which finer frames the examples give.
struct Pattern {
    std::array<int, 3> target;
    std::array<int, 3> example;
    std::array<bool, 2> gives;
};
constexpr Pattern kSplitPattern{{0, -1, 1}, {0, -2, 2}, {true, true}};
constexpr Pattern kInsertPattern{{0, 1, 1}, {0, 2, 2}, {false, true}};

constexpr float kStill = 1.2F;       ///< of a patch without motion, in its noise
constexpr float kStillRoot = 0.01F;  ///< on the scale 2 sqrt(light)

/// The mean of 2 x 2 pixels; a last odd row or column is left out.
FluxVideo halved(const FluxVideo& video) {
    const FrameShape shape{video.shape().rows / 2, video.shape().cols / 2, video.shape().planes};
    FluxVideo result(video.slots(), shape);
    for (int frame = 0; frame < video.slots(); ++frame)
        for (int plane = 0; plane < shape.planes; ++plane) {
            const auto from = video.plane(frame, plane);
            const auto to = result.plane(frame, plane);
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col)
                    to(row, col) = ((from(2 * row, 2 * col) + from(2 * row, 2 * col + 1)) +
                                    (from(2 * row + 1, 2 * col) + from(2 * row + 1, 2 * col + 1))) /
                                   4;
        }
    return result;
}

/// Means of successive frames: exposures of twice the length, one for each frame but the last.
FluxVideo paired(const FluxVideo& video) {
    FluxVideo result(std::max(video.slots() - 1, 0), video.shape());
    for (int frame = 0; frame < result.slots(); ++frame)
        for (std::size_t i = 0; i < video.shape().sites(); ++i)
            result.frame(frame)[i] = (video.frame(frame)[i] + video.frame(frame + 1)[i]) / 2;
    return result;
}

/// 2 sqrt(light of all planes): shot noise has the same variance everywhere.
FluxVideo root_of(const FluxVideo& video) {
    constexpr float kOffset = 0.01F;
    const FrameShape shape{video.shape().rows, video.shape().cols, 1};
    FluxVideo root(video.slots(), shape);
    for (int frame = 0; frame < video.slots(); ++frame) {
        const auto to = root.frame(frame);
        std::ranges::fill(to, kOffset);
        for (std::size_t i = 0; i < video.shape().sites(); ++i)
            to[i % to.size()] += std::max(video.frame(frame)[i], 0.0F);
        for (float& value : to) value = 2 * std::sqrt(value);
    }
    return root;
}

/// Examples at one spatial scale.
struct Scale {
    int shrink;        ///< of rows and columns
    FluxVideo fine;    ///< light
    FluxVideo coarse;  ///< root
    float noise;       ///< expected square difference to a patch of the frames
};

struct Place {
    int frame;
    int row;
    int col;
};

/// A match of a patch.
struct Example {
    float distance;
    const Scale* scale;
    Place at;
};

class OctaveSolver {
  public:
    OctaveSolver(const FluxVideo& frames, Octave octave, float per_light,
                 const OctaveOptions& options)
        : frames_(frames),
          shape_(frames.shape()),
          options_(options),
          split_(octave == Octave::kSplit),
          pattern_(split_ ? kSplitPattern : kInsertPattern),
          still_(kStill * 4 * per_light + kStillRoot * kStillRoot),
          root_(root_of(frames)) {
        add_scale(1, frames, per_light);
        if (std::min(shape_.rows, shape_.cols) >= 4 * options.patch_px)
            add_scale(2, halved(frames), per_light);
    }

    FluxVideo solve() {
        const int count = frames_.slots();
        std::vector<float> centres;
        centres.reserve(index(count));
        for (int k = 0; k < count; ++k)
            centres.push_back(static_cast<float>(2 * k) + (split_ ? 0.5F : 0.0F));
        FluxVideo result = interpolate_frames(frames_, centres, split_ ? 2 * count : 2 * count - 1);
        if (count >= 4 && std::min(shape_.rows, shape_.cols) >= options_.patch_px)
            parallel_for(0, split_ ? count : count - 1, [&](int k) { improve(k, result); });
        parallel_for(0, count, [&](int k) { keep_frame(k, result); });
        return result;
    }

  private:
    void add_scale(int shrink, FluxVideo fine, float per_light) {
        FluxVideo coarse = root_of(split_ ? paired(fine) : fine);
        const float means = static_cast<float>(shrink * shrink) * (split_ ? 2 : 1);
        scales_.push_back(
            {shrink, std::move(fine), std::move(coarse),
             per_light * (1 + 1 / means) + options_.match_sigma * options_.match_sigma});
    }

    /// Averages the examples of frame k with the estimates of its finer frames.
    void improve(int k, FluxVideo& result) const {
        const int fine = std::min(2, result.slots() - 2 * k);
        std::vector<FluxVideo> sum(2, FluxVideo(1, shape_));
        std::vector<float> weight(shape_.pixels());
        std::vector<Example> examples;
        const auto last = [&](int side) { return side - options_.patch_px; };
        const int step = std::min(options_.step_px, options_.patch_px);
        for (int row = 0;; row = std::min(row + step, last(shape_.rows))) {
            for (int col = 0;; col = std::min(col + step, last(shape_.cols))) {
                find({k, row, col}, examples);
                for (const Example& example : examples) add(example, {k, row, col}, sum, weight);
                if (col == last(shape_.cols)) break;
            }
            if (row == last(shape_.rows)) break;
        }
        for (int i = 0; i < fine; ++i) {
            if (!pattern_.gives[index(i)]) continue;
            const auto light = result.frame(2 * k + i);
            for (std::size_t site = 0; site < light.size(); ++site) {
                const float w = weight[site % weight.size()];
                light[site] = (options_.start_weight * light[site] + sum[index(i)].frame(0)[site]) /
                              (options_.start_weight + w);
            }
        }
    }

    [[nodiscard]] int clamped(int frame) const { return std::clamp(frame, 0, frames_.slots() - 1); }

    /// The most similar patches of the coarse frames, if the patch changes with time.
    void find(const Place& target, std::vector<Example>& examples) const {
        examples.clear();
        const auto change = [&](int step) {
            const Place then{clamped(target.frame + step), target.row, target.col};
            return difference(root_, then, root_, target);
        };
        if (change(-1) + change(1) < still_) return;
        for (const Scale& scale : scales_) search(target, scale, examples);
    }

    void search(const Place& target, const Scale& scale, std::vector<Example>& examples) const {
        const int first =
            std::max({target.frame - options_.search_frames, -pattern_.example[1], 0});
        const int last = std::min(target.frame + options_.search_frames,
                                  scale.coarse.slots() - 1 - pattern_.example[2]);
        const int middle = options_.patch_px / 2;
        const auto centre = [&](int at) { return (at + middle) / scale.shrink - middle; };
        const FrameShape shape = scale.coarse.shape();
        const auto begin = [&](int at) { return std::max(centre(at) - options_.search_px, 0); };
        const auto end = [&](int at, int side) {
            return std::min(centre(at) + options_.search_px, side - options_.patch_px);
        };
        for (int frame = first; frame <= last; ++frame)
            for (int row = begin(target.row); row <= end(target.row, shape.rows); ++row)
                for (int col = begin(target.col); col <= end(target.col, shape.cols); ++col)
                    consider(target, scale, {frame, row, col}, examples);
    }

    /// Keeps the nearest, in the order of their distance.
    void consider(const Place& target, const Scale& scale, const Place& at,
                  std::vector<Example>& examples) const {
        constexpr float kFarthest = 4;  // in expected differences
        const bool full = examples.size() == index(options_.examples);
        const float limit = full ? examples.back().distance : kFarthest;
        float sum = 0;
        for (std::size_t i = 0; i < pattern_.target.size(); ++i) {
            sum += difference(scale.coarse, {at.frame + pattern_.example[i], at.row, at.col}, root_,
                              {clamped(target.frame + pattern_.target[i]), target.row, target.col});
            if (sum >= 3 * limit * scale.noise) return;
        }
        const Example example{sum / (3 * scale.noise), &scale, at};
        const auto place =
            std::ranges::upper_bound(examples, example.distance, {}, &Example::distance);
        examples.insert(place, example);
        if (examples.size() > index(options_.examples)) examples.pop_back();
    }

    /// Mean square difference of two patches.
    [[nodiscard]] float difference(const FluxVideo& a, const Place& in_a, const FluxVideo& b,
                                   const Place& in_b) const {
        const int side = options_.patch_px;
        const auto plane_a = a.plane(in_a.frame, 0);
        const auto plane_b = b.plane(in_b.frame, 0);
        float sum = 0;
        for (int row = 0; row < side; ++row) {
            const float* x = &plane_a(in_a.row + row, in_a.col);
            const float* y = &plane_b(in_b.row + row, in_b.col);
            for (int i = 0; i < side; ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
        }
        return sum / static_cast<float>(side * side);
    }

    void add(const Example& example, const Place& target, std::vector<FluxVideo>& sum,
             std::vector<float>& weight) const {
        const float w = fast_gaussian(example.distance);
        const int side = options_.patch_px;
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col) {
                weight[row_major(target.row + row, target.col + col, shape_.cols)] += w;
                for (int i = 0; i < 2; ++i)
                    for (int plane = 0; plane < shape_.planes; ++plane)
                        sum[index(i)].plane(0, plane)(target.row + row, target.col + col) +=
                            w * example.scale->fine.plane(example.at.frame + i, plane)(
                                    example.at.row + row, example.at.col + col);
            }
    }

    /// The given frame is the mean of its pair, or the first of it.
    void keep_frame(int k, FluxVideo& result) const {
        const auto given = frames_.frame(k);
        const auto first = result.frame(2 * k);
        if (!split_) {
            std::ranges::copy(given, first.begin());
            return;
        }
        const auto second = result.frame(2 * k + 1);
        for (std::size_t i = 0; i < given.size(); ++i) {
            const float lack = given[i] - (first[i] + second[i]) / 2;
            first[i] += lack;
            second[i] += lack;
        }
    }

    const FluxVideo& frames_;
    FrameShape shape_;
    const OctaveOptions& options_;
    bool split_;
    Pattern pattern_;
    float still_;  ///< square difference of a patch to the frames before and after it, together
    FluxVideo root_;
    std::vector<Scale> scales_;
};

}  // namespace

FluxVideo upsampled_frames(const FluxVideo& frames, Octave octave, float per_light,
                           const OctaveOptions& options) {
    return OctaveSolver(frames, octave, per_light, options).solve();
}

}  // namespace stipple
