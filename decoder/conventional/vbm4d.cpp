#include "decoder/conventional/vbm4d.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/conventional/block_filter.h"
#include "decoder/conventional/frame_decoding.h"
#include "decoder/conventional/volume_transform.h"

namespace stipple {
namespace {

/// What one of the two stages compares, and what it filters by.
struct Stage {
    const FluxVideo& noisy;
    const FluxVideo* pilot;     ///< null in the first stage
    const FluxVideo& compared;  ///< noisy or pilot
    float sigma;
    float max_distance;  ///< mean square
};

/// Filters the group of one reference block.
class VolumeFilter {
  public:
    VolumeFilter(const Stage& stage, const Vbm4dOptions& options, const BlockPaths& paths,
                 const VolumeTransform& transform)
        : stage_(stage), options_(options), paths_(paths), transform_(transform) {}

    [[nodiscard]] FilteredBlocks filter(const BlockPlace& reference) {
        paths_.follow(reference, options_.reach_frames,
                      static_cast<std::uint8_t>(options_.min_confidence), reference_path_);
        find_similar(reference);
        const int volumes = static_cast<int>(std::bit_floor(static_cast<unsigned>(
            std::min<std::size_t>(similar_.size(), index(options_.max_volumes)))));
        FilteredBlocks result;
        for (int i = 0; i < volumes; ++i)
            result.places.insert(result.places.end(), similar_[index(i)].path.begin(),
                                 similar_[index(i)].path.end());
        const int frames = static_cast<int>(reference_path_.size());
        for (int plane = 0; plane < stage_.noisy.shape().planes; ++plane)
            filter_plane(plane, volumes, frames, result);
        return result;
    }

  private:
    struct Volume {
        float distance = 0;
        std::vector<BlockPlace> path;
    };

    /// Volumes that begin near the reference, in its frame, by their distance; first the reference.
    void find_similar(const BlockPlace& reference) {
        similar_.assign(1, {0, reference_path_});
        const FrameShape shape = stage_.noisy.shape();
        const int radius = options_.search_px;
        const int last_row = std::min(reference.row + radius, shape.rows - kBlockSide);
        const int last_col = std::min(reference.col + radius, shape.cols - kBlockSide);
        std::vector<BlockPlace> path;
        for (int row = std::max(reference.row - radius, 0); row <= last_row; ++row)
            for (int col = std::max(reference.col - radius, 0); col <= last_col; ++col) {
                if (row == reference.row && col == reference.col) continue;
                paths_.follow_unchecked({reference.frame, row, col}, reference_path_.front().frame,
                                        reference_path_.back().frame, path);
                const float distance = distance_to(path);
                if (distance <= stage_.max_distance) similar_.push_back({distance, path});
            }
        std::stable_sort(similar_.begin() + 1, similar_.end(),
                         [](const Volume& a, const Volume& b) { return a.distance < b.distance; });
    }

    /// Mean square difference of the first plane; more than the maximum if it is stopped early.
    [[nodiscard]] float distance_to(const std::vector<BlockPlace>& path) const {
        const float limit = stage_.max_distance * static_cast<float>(path.size() * kBlockPixels);
        float sum = 0;
        for (std::size_t i = 0; i < path.size() && sum <= limit; ++i)
            sum += squared_difference(stage_.compared, reference_path_[i], path[i]);
        return sum / static_cast<float>(path.size() * kBlockPixels);
    }

    static float squared_difference(const FluxVideo& video, const BlockPlace& a,
                                    const BlockPlace& b) {
        float sums[kBlockSide] = {};
        const auto in_a = video.plane(a.frame, 0);
        const auto in_b = video.plane(b.frame, 0);
        for (int row = 0; row < kBlockSide; ++row) {
            const float* x = &in_a(a.row + row, a.col);
            const float* y = &in_b(b.row + row, b.col);
            for (int i = 0; i < kBlockSide; ++i) sums[i] += (x[i] - y[i]) * (x[i] - y[i]);
        }
        return ((sums[0] + sums[1]) + (sums[2] + sums[3])) +
               ((sums[4] + sums[5]) + (sums[6] + sums[7]));
    }

    void filter_plane(int plane, int volumes, int frames, FilteredBlocks& result) {
        load(stage_.noisy, plane, result.places, noisy_);
        transform_.forward(volumes, frames, noisy_);
        float squares = 0;
        if (stage_.pilot == nullptr) {
            const float threshold = options_.threshold * stage_.sigma;
            for (float& value : noisy_) {
                const bool kept = value > threshold || value < -threshold;
                squares += kept ? 1.0F : 0.0F;
                if (!kept) value = 0;
            }
        } else {
            load(*stage_.pilot, plane, result.places, pilot_);
            transform_.forward(volumes, frames, pilot_);
            const float noise = stage_.sigma * stage_.sigma;
            for (std::size_t i = 0; i < noisy_.size(); ++i) {
                const float power = pilot_[i] * pilot_[i];
                const float factor = power / (power + noise);
                noisy_[i] *= factor;
                squares += factor * factor;
            }
        }
        transform_.inverse(volumes, frames, noisy_);
        result.values.insert(result.values.end(), noisy_.begin(), noisy_.end());
        result.weights.push_back(1 / std::max(squares, 1.0F));
    }

    static void load(const FluxVideo& video, int plane, const std::vector<BlockPlace>& places,
                     std::vector<float>& values) {
        values.clear();
        for (const BlockPlace& place : places)
            for (int row = 0; row < kBlockSide; ++row) {
                const auto line = video.plane(place.frame, plane)
                                      .row(place.row + row)
                                      .subspan(index(place.col), kBlockSide);
                values.insert(values.end(), line.begin(), line.end());
            }
    }

    Stage stage_;
    const Vbm4dOptions& options_;
    const BlockPaths& paths_;
    const VolumeTransform& transform_;
    std::vector<BlockPlace> reference_path_;
    std::vector<Volume> similar_;
    std::vector<float> noisy_;
    std::vector<float> pilot_;
};

/// One stage on all reference blocks.
std::optional<FluxVideo> run(const Stage& stage, const Vbm4dOptions& options,
                             const FluxVideo& light, const ProgressCallback& progress) {
    const BlockPaths paths(light, kBlockSide);
    const VolumeTransform transform;
    return filter_blocks(
        {light.slots(), light.shape(), kBlockSide, options.step_px},
        [&](const BlockPlace& reference) {
            return VolumeFilter(stage, options, paths, transform).filter(reference);
        },
        progress);
}

}  // namespace

std::optional<FluxVideo> filter_volumes(const DeliveredFrames& frames, const Vbm4dOptions& options,
                                        const ProgressCallback& progress) {
    const FrameShape shape = frames.light.shape();
    if (std::min(shape.rows, shape.cols) < kBlockSide) return frames.light;
    const StabilisedFrames noisy = stabilised(frames);
    const float variance = noisy.sigma * noisy.sigma;
    const auto basic =
        run({noisy.values, nullptr, noisy.values, noisy.sigma, options.max_distance1 * variance},
            options, frames.light, [&](double done) { return progress(done / 2); });
    if (!basic) return {};
    const auto result =
        run({noisy.values, &*basic, *basic, noisy.sigma, options.max_distance2 * variance}, options,
            restored(*basic, noisy.scale, frames.noise),
            [&](double done) { return progress((1 + done) / 2); });
    if (!result) return {};
    return restored(*result, noisy.scale, frames.noise);
}

void read_options(Config& config, Vbm4dOptions& options) {
    const KeyReader read(config);
    constexpr int kMaxReach = kMaxVolumeFrames / 2;
    read({"reach_frames",
          {0, kMaxReach},
          "frames",
          "frames of a volume before and after its reference"},
         options.reach_frames);
    read({"step_px", {1, kBlockSide}, "pixels", "stride of reference blocks"}, options.step_px);
    read({"search_px", {0, 32}, "pixels", "search radius of similar volumes"}, options.search_px);
    read({"max_volumes", {1, kMaxGroupVolumes}, "", "most volumes of a group; a power of 2 counts"},
         options.max_volumes);
    read({"threshold", {0, 100}, "", "threshold of stage 1, in standard deviations"},
         options.threshold);
    read({"max_distance1", {0, 1e4}, "", "mean square of similar volumes, in variances, stage 1"},
         options.max_distance1);
    read({"max_distance2", {0, 1e4}, "", "the same in stage 2"}, options.max_distance2);
    read({"min_confidence", {0, 255}, "", "least confidence of the motion of a volume"},
         options.min_confidence);
}

}  // namespace stipple
