#pragma once

#include <optional>
#include <span>
#include <string>

#include "capture/recording/read_ahead.h"
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

/// Footage or a recording as slots of a sensor.
class ResampledFootage {
  public:
    /// `footage` must outlive it; messages call it `name`. \throws InputError if a method needs the
    /// frame rate and it is unknown or out of range, or if kFlow would mix the colours of a mosaic.
    ResampledFootage(ReadAhead& footage, const std::string& name, const SlotOptions& options);

    /// Number of slots, if the footage declares its number of frames.
    [[nodiscard]] std::optional<int> slots() const;

    /// The next slot, order (plane, row, col), valid until the next call, or an empty span at the
    /// end. \throws as ReadAhead::next and the flow.
    std::span<const float> next();
    /// Leaves out the next `slots` slots. \throws as `next`.
    void skip(int slots);

  private:
    ReadAhead& footage_;
    double frames_per_slot_ = 1;
    std::optional<FrameResampler> resampler_;  ///< none: each frame is a slot
};

}  // namespace stipple
