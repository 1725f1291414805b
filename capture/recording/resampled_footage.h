#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "capture/recording/read_ahead.h"
#include "core/colour_filter.h"
#include "core/geometry.h"
#include "io/frame_resampler.h"

namespace stipple {

/// How frames of footage become slots of a sensor.
struct SlotOptions {
    std::optional<Resampling> method = {};  ///< none: each frame is a slot
    std::optional<double> frames_hz = {};   ///< frame rate, instead of that of the footage
    double slot_us = 0;                     ///< above 0, with a method
    FlowFunction flow = {};                 ///< as in ResamplingOptions
    int min_flow_side = 0;                  ///< as in ResamplingOptions
};

/// Frames, and what is known of them before they are read.
struct FootageSource {
    FrameShape shape;
    ColourFilter filter = ColourFilter::kNone;
    std::optional<std::int64_t> frames = {};
    std::optional<double> frames_hz = {};
    std::function<std::span<const float>()> next;  ///< as ReadAhead::next
    std::function<void(int)> skip = {};            ///< as ReadAhead::skip; none: reads them
    std::function<double()> time = {};  ///< as ReadAhead::frame_time; none: equally long frames
};

/// Frames as slots of a sensor.
class ResampledFootage {
  public:
    /// Messages call the source `name`. \throws InputError if a method needs the frame rate and it
    /// is unknown or out of range, or if kFlow would mix the colours of a mosaic.
    ResampledFootage(FootageSource source, const std::string& name, const SlotOptions& options);
    /// The same of footage or a recording, which must outlive it.
    ResampledFootage(ReadAhead& footage, const std::string& name, const SlotOptions& options);

    /// Number of slots, if the footage declares its number of frames and these are equally long.
    [[nodiscard]] std::optional<std::int64_t> slots() const;

    /// The next slot, order (plane, row, col), valid until the next call, or an empty span at the
    /// end. \throws as ReadAhead::next and the flow.
    std::span<const float> next();
    /// Leaves out the next `slots` slots. \throws as `next`.
    void skip(int slots);

  private:
    std::span<const float> next_frame(const std::string& name);

    FootageSource source_;
    double frames_per_slot_ = 1;
    std::optional<double> last_time_;          ///< of a frame, in frame periods
    std::optional<FrameResampler> resampler_;  ///< none: each frame is a slot
};

}  // namespace stipple
