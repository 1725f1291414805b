#include "decoder/conventional/kang2003.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/conventional/fast_gaussian.h"
#include "decoder/conventional/frame_decoding.h"
#include "decoder/decode_method.h"
#include "decoder/fast/box_blur.h"
#include "decoder/frame_exposures.h"
#include "decoder/measurements.h"
#include "decoder/motion/frame_interpolation.h"

namespace stipple {
namespace {

constexpr float kLeastVariance = 1e-12F;    ///< of samples without noise
constexpr float kNearlySaturated = 0.999F;  ///< of the bound: interpolation rounds

void scale(FluxVideo& video, float factor) {
    for (float& light : video.data()) light *= factor;
}

/// Divides light beyond 1, the range of motion estimation, by the brightest, which is returned.
float normalise(FluxVideo& frames) {
    const float brightest = std::max(std::ranges::max(frames.data()), 1.0F);
    scale(frames, 1 / brightest);
    return brightest;
}

/// The frames of one exposure time.
struct ExposureTime {
    float slots;
    std::vector<int> numbers;    ///< of the frames, among all
    std::vector<float> centres;  ///< slots
    DeliveredFrames frames;
    float saturation;  ///< least bound of their light, infinite without

    [[nodiscard]] float variance(float light) const {
        return frames.noise.variance(light) + kLeastVariance;
    }
};

ExposureTime exposure_time(const BlockTask& block, std::span<const FrameExposure> all, int slots) {
    std::vector<int> numbers;
    std::vector<FrameExposure> own;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].open_slots == slots) {
            numbers.push_back(static_cast<int>(i));
            own.push_back(all[i]);
        }
    DeliveredFrames frames = delivered_frames(block, own);
    float saturation = std::numeric_limits<float>::infinity();
    for (const float bound : frames.bounds)
        if (bound > 0) saturation = std::min(saturation, bound);
    if (block.measurements.mosaic)  // colours that pixels do not measure, filled with bounds
        for (std::size_t i = 0; i < frames.bounds.size(); ++i)
            if (frames.light.data()[i] >= kNearlySaturated * saturation)
                frames.bounds[i] = frames.light.data()[i];
    return {static_cast<float>(slots), std::move(numbers), centre_slots(own), std::move(frames),
            saturation};
}

/// A frame and what is merged with it.
class MergedFrame {
  public:
    /// `number` counts the frames of the exposure time.
    MergedFrame(const ExposureTime& time, int number)
        : time_(time),
          light_(time.frames.light.frame(number)),
          bounds_(std::span(time.frames.bounds).subspan(index(number) * light_.size())),
          shape_(time.frames.light.shape()),
          sum_(light_.begin(), light_.end()),
          weights_(light_.size(), 1.0F),
          brightest_(sum_) {
        for (std::size_t i = 0; i < sum_.size(); ++i)
            if (saturated(i)) sum_[i] = weights_[i] = 0;
    }

    /// Adds a frame before or after this one, clipped at `limit`, where both are measured, as far
    /// as it agrees with this one.
    void add_neighbour(const ExposureTime& other, std::span<const float> light, float limit) {
        const auto measured = [&](std::size_t i) {
            return !saturated(i) && light[i] < kNearlySaturated * limit;
        };
        const std::vector<float> likeness = likeness_to(other, light, measured);
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            if (!measured(i)) continue;
            const float expected = mean_light(i, other, light[i]);
            const float weight =
                likeness[i % likeness.size()] * time_.variance(expected) / other.variance(expected);
            sum_[i] += weight * light[i];
            weights_[i] += weight;
        }
    }

    /// Adds the frames of another exposure time where this one is saturated and they are not.
    void fill(const ExposureTime& other, std::span<const float> light) {
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            if (!saturated(i)) continue;
            brightest_[i] = std::max(brightest_[i], light[i]);
            if (light[i] >= kNearlySaturated * other.saturation) continue;
            const float weight = 1 / other.variance(light[i]);
            sum_[i] += weight * light[i];
            weights_[i] += weight;
        }
    }

    void write(std::span<float> merged) const {
        for (std::size_t i = 0; i < merged.size(); ++i) {
            merged[i] = weights_[i] > 0 ? sum_[i] / weights_[i] : brightest_[i];
            merged[i] = saturated(i) ? std::max(merged[i], bounds_[i]) : merged[i];
        }
    }

  private:
    [[nodiscard]] bool saturated(std::size_t i) const { return bounds_[i] > 0; }

    /// By the exposure times, the best weights of shot noise. Variances of the single samples would
    /// prefer those that are too low.
    [[nodiscard]] float mean_light(std::size_t i, const ExposureTime& other, float light) const {
        return (time_.slots * light_[i] + other.slots * light) / (time_.slots + other.slots);
    }

    /// By the difference D of the neighbourhoods of each pixel, where both are measured; noise
    /// alone gives 1.
    template <typename Measured>
    [[nodiscard]] std::vector<float> likeness_to(const ExposureTime& other,
                                                 std::span<const float> light,
                                                 const Measured& measured) const {
        std::vector<float> likeness(shape_.pixels());
        std::vector<float> noise(shape_.pixels());
        for (std::size_t i = 0; i < light.size(); ++i) {
            if (!measured(i)) continue;
            const float difference = light[i] - light_[i];
            const float expected = mean_light(i, other, light[i]);
            likeness[i % likeness.size()] += difference * difference;
            noise[i % noise.size()] += time_.variance(expected) + other.variance(expected);
        }
        box_blur({shape_.rows, shape_.cols, 1}, likeness);
        box_blur({shape_.rows, shape_.cols, 1}, noise);
        for (std::size_t i = 0; i < likeness.size(); ++i) {
            const float excess = noise[i] > 0 ? std::max(likeness[i] / noise[i] - 1, 0.0F) : 0.0F;
            likeness[i] = fast_gaussian(excess * excess / 8);
        }
        return likeness;
    }

    const ExposureTime& time_;
    std::span<const float> light_;
    std::span<const float> bounds_;
    FrameShape shape_;
    std::vector<float> sum_;
    std::vector<float> weights_;    ///< the own one is 1
    std::vector<float> brightest_;  ///< if all are saturated, the highest bound
};

/// Frames by their exposure time, and in temporal order.
class FrameSequence {
  public:
    FrameSequence(const BlockTask& block, std::span<const FrameExposure> exposures)
        : centres_(centre_slots(exposures)), times_of_frames_(exposures.size()) {
        std::set<int> lengths;
        for (const FrameExposure& exposure : exposures) lengths.insert(exposure.open_slots);
        for (const int length : lengths) times_.push_back(exposure_time(block, exposures, length));
        for (const ExposureTime& time : times_)
            for (const int number : time.numbers) times_of_frames_[index(number)] = &time;
    }

    [[nodiscard]] FluxVideo merged() const {
        FluxVideo result(static_cast<int>(centres_.size()), times_.front().frames.light.shape());
        const float limit = least_saturation();
        const MovedFrames neighbours = neighbours_below(limit);
        std::vector<FluxVideo> moved;
        for (const ExposureTime& time : times_) moved.push_back(at_all_times(time));
        for (const ExposureTime& time : times_)
            parallel_for(0, static_cast<int>(time.numbers.size()), [&](int i) {
                const int number = time.numbers[index(i)];
                MergedFrame frame(time, i);
                if (number > 0)
                    frame.add_neighbour(*times_of_frames_[index(number - 1)],
                                        neighbours.previous.frame(number), limit);
                if (number + 1 < result.slots())
                    frame.add_neighbour(*times_of_frames_[index(number + 1)],
                                        neighbours.next.frame(number), limit);
                for (std::size_t k = 0; k < times_.size(); ++k)
                    if (&times_[k] != &time) frame.fill(times_[k], moved[k].frame(number));
                frame.write(result.frame(number));
            });
        return result;
    }

  private:
    [[nodiscard]] float least_saturation() const {
        return std::ranges::min(times_, {}, &ExposureTime::saturation).saturation;
    }

    [[nodiscard]] MovedFrames neighbours_below(float limit) const {
        FluxVideo frames(static_cast<int>(centres_.size()), times_.front().frames.light.shape());
        for (const ExposureTime& time : times_)
            for (std::size_t i = 0; i < time.numbers.size(); ++i)
                std::ranges::transform(time.frames.light.frame(static_cast<int>(i)),
                                       frames.frame(time.numbers[i]).begin(),
                                       [&](float light) { return std::min(light, limit); });
        const float brightest = normalise(frames);
        MovedFrames moved = move_frames(frames);
        scale(moved.previous, brightest);
        scale(moved.next, brightest);
        return moved;
    }

    [[nodiscard]] FluxVideo at_all_times(const ExposureTime& time) const {
        FluxVideo frames = time.frames.light;
        const float brightest = normalise(frames);
        FluxVideo moved = interpolate_frames(frames, time.centres, centres_);
        scale(moved, brightest);
        return moved;
    }

    std::vector<float> centres_;  ///< of all frames, slots
    std::vector<ExposureTime> times_;
    std::vector<const ExposureTime*> times_of_frames_;
};

}  // namespace

std::optional<FluxVideo> merge_exposure_times(const BlockTask& block) {
    const Measurements& measurements = block.measurements;
    const auto exposures = exposures_of_frames(measurements, FrameLengths::kAny);
    if (exposures.empty()) return FluxVideo(measurements.slots, measurements.shape);
    FluxVideo merged = FrameSequence(block, exposures).merged();
    if (!block.progress(0.5)) return {};
    const float brightest = normalise(merged);
    FluxVideo video = video_of_frames(measurements, exposures, merged);
    scale(video, brightest);
    return video;
}

}  // namespace stipple
