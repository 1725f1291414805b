#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/named_value.h"
#include "core/plane.h"

namespace stipple {

/// The least and the most frames a slot: beyond them the times of slots are no longer exact, and a
/// frame would make more slots than anybody looks at.
inline constexpr double kMinFramesPerSlot = 1e-4;
inline constexpr double kMaxFramesPerSlot = 1e6;

/// How footage of one frame rate becomes slots of another.
enum class Resampling {
    kHold,   ///< the frame at the beginning of the slot
    kBlend,  ///< the light that falls into the slot
    kFlow,   ///< as kBlend; where slots are shorter than frames, frames moved by optical flow
};

inline constexpr auto kResamplings = std::to_array<NamedValue<Resampling>>(
    {{"hold", Resampling::kHold}, {"blend", Resampling::kBlend}, {"flow", Resampling::kFlow}});

/// Dense motion between images: (x, y) in pixels for each pixel.
using FlowFunction = std::function<void(PlaneView<const float> from, PlaneView<const float> to,
                                        std::span<float> flow)>;

struct ResamplingOptions {
    Resampling method = Resampling::kHold;
    double frames_per_slot = 1;  ///< kMinFramesPerSlot to kMaxFramesPerSlot
    FlowFunction flow = {};      ///< of kFlow; empty: frames are blended without motion
    int min_flow_side = 0;       ///< pixels; smaller frames are blended without motion
    /// t_j of the frame that the source gave last, above that of the frame before; empty: j
    std::function<double()> time = {};
};

/// Resamples linear light in time. Frame j is the mean light of the time from t_j to t_(j + 1),
/// slot k that of [k, k + 1) x frames_per_slot; t_j is j, or what the footage declares, and the
/// last frame takes 1. Slots that are not wholly within the footage are left out. With one frame
/// per slot and t_j = j every method returns the frames themselves.
///
/// kBlend: the light collected until the time t is known at the ends of frames; between them it is
/// the monotone cubic of Fritsch and Carlson (SIAM J. Numer. Anal., 1980) with the slopes
/// min((a h_b + b h_a) / (h_a + h_b), 3 min(a, b)) of neighbouring frames a, b of the lengths h. So
/// the slots hold the light of the frames, it is never negative, and light that is linear in time
/// stays so.
///
/// kFlow: frames are taken for moments, 1/2 after t_j. Those before and after the middle of the
/// slot are moved to it by the flows F, B between them: at the phase s by -(1 - s) s F + s^2 B and
/// (1 - s)^2 F - s (1 - s) B (Jiang et al., "Super SloMo", CVPR 2018, eq. 4), and blended with the
/// weights 1 - s and s. Not modelled: occlusion, and the motion blur of the frames, which stays.
class FrameResampler {
  public:
    /// The next frame, order (plane, row, col); empty at the end.
    using Source = std::function<std::span<const float>()>;

    FrameResampler(FrameShape shape, ResamplingOptions options, Source source);

    /// The next slot, valid until the next call; empty at the end. \throws as the source.
    std::span<const float> next();

  private:
    using Frame = std::vector<float>;
    struct TimedFrame {
        double begin;
        Frame light;
    };

    [[nodiscard]] bool have(std::int64_t index);
    [[nodiscard]] bool advance();
    [[nodiscard]] bool reach(double time);
    [[nodiscard]] const Frame& frame(std::int64_t index) const;
    [[nodiscard]] double begin_of(std::int64_t index) const;
    [[nodiscard]] double end_of(std::int64_t index);
    [[nodiscard]] bool blend(double begin, double end);
    void add_part(double begin, double end);
    void interpolate(double time);
    void move_row(int row, std::int64_t index, float phase);
    void find_flow(std::int64_t index);

    FrameShape shape_;
    ResamplingOptions options_;
    Source source_;
    std::deque<TimedFrame> frames_;
    std::int64_t first_ = 0;  ///< index of frames_.front()
    std::int64_t at_ = 0;     ///< frame of the time that was reached
    double origin_ = 0;       ///< t_0
    std::int64_t slot_ = 0;
    bool ended_ = false;
    Frame light_;                          ///< of the slot
    std::optional<std::int64_t> flow_of_;  ///< frame from which forth_ starts
    std::vector<float> forth_;
    std::vector<float> back_;
};

/// Slots that `frames` frames give. Precondition: frames_per_slot >= kMinFramesPerSlot.
[[nodiscard]] std::int64_t resampled_slots(std::int64_t frames, double frames_per_slot);

}  // namespace stipple
