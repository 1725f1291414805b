#include "capture/recording/resampled_footage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/error.h"

namespace stipple {

ResampledFootage::ResampledFootage(ReadAhead& footage, const std::string& name,
                                   const SlotOptions& options)
    : footage_(footage) {
    if (!options.method) return;
    const auto hz = options.frames_hz ? options.frames_hz : footage.frames_hz();
    if (!hz)
        throw InputError(name, "does not declare its frame rate; --resample needs --frames-hz");
    if (options.method == Resampling::kFlow && footage.filter() != ColourFilter::kNone)
        throw InputError(name,
                         "is the mosaic of a colour filter array, whose colours --resample flow "
                         "would mix; use blend");
    frames_per_slot_ = *hz * options.slot_us * 1e-6;
    if (!(frames_per_slot_ >= kMinFramesPerSlot && frames_per_slot_ <= kMaxFramesPerSlot))
        throw InputError(
            name,
            fmt::format(
                "has {:.4g} frames/s, which are {:.4g} a slot of {:g} us; --resample takes {:g} "
                "to {:g}, so check the rate (--frames-hz) and sensor.slot_us",
                *hz, frames_per_slot_, options.slot_us, kMinFramesPerSlot, kMaxFramesPerSlot));
    resampler_.emplace(footage.shape(),
                       ResamplingOptions{.method = *options.method,
                                         .frames_per_slot = frames_per_slot_,
                                         .flow = options.flow,
                                         .min_flow_side = options.min_flow_side},
                       [&footage] { return footage.next(); });
}

std::optional<int> ResampledFootage::slots() const {
    const auto frames = footage_.slots();
    if (!frames || !resampler_) return frames;
    return static_cast<int>(std::min<std::int64_t>(resampled_slots(*frames, frames_per_slot_),
                                                   std::numeric_limits<int>::max()));
}

std::span<const float> ResampledFootage::next() {
    return resampler_ ? resampler_->next() : footage_.next();
}

void ResampledFootage::skip(int slots) {
    if (!resampler_) return footage_.skip(slots);
    for (int i = 0; i < slots && !resampler_->next().empty(); ++i) {
    }
}

}  // namespace stipple
