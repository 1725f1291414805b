#include "capture/recording/resampled_footage.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"

namespace stipple {

ResampledFootage::ResampledFootage(ReadAhead& footage, const std::string& name,
                                   const SlotOptions& options)
    : ResampledFootage({.shape = footage.shape(),
                        .filter = footage.filter(),
                        .frames = footage.slots(),
                        .frames_hz = footage.frames_hz(),
                        .next = [&footage] { return footage.next(); },
                        .skip = [&footage](int frames) { footage.skip(frames); },
                        .time = footage.has_times() ? [&footage] { return footage.frame_time(); }
                                                    : std::function<double()>()},
                       name, options) {}

ResampledFootage::ResampledFootage(FootageSource source, const std::string& name,
                                   const SlotOptions& options)
    : source_(std::move(source)) {
    if (!options.method) return;
    const auto hz = options.frames_hz ? options.frames_hz : source_.frames_hz;
    if (!hz)
        throw InputError(name, "does not declare its frame rate; " + Parameter{"resample"} +
                                   " needs " + Parameter{"frames_hz"});
    if (options.method == Resampling::kFlow && source_.filter != ColourFilter::kNone)
        throw InputError(name, "is the mosaic of a colour filter array, whose colours " +
                                   Parameter{"resample", "flow"} + " would mix; use blend");
    frames_per_slot_ = *hz * options.slot_us * 1e-6;
    if (!(frames_per_slot_ >= kMinFramesPerSlot && frames_per_slot_ <= kMaxFramesPerSlot))
        throw InputError(
            name, fmt::format("has {:.4g} frames/s, which are {:.4g} a slot of {:g} us; ", *hz,
                              frames_per_slot_, options.slot_us) +
                      Parameter{"resample"} +
                      fmt::format(" takes {:g} to {:g}, so check the rate (", kMinFramesPerSlot,
                                  kMaxFramesPerSlot) +
                      Parameter{"frames_hz"} + ") and sensor.slot_us");
    resampler_.emplace(source_.shape,
                       ResamplingOptions{.method = *options.method,
                                         .frames_per_slot = frames_per_slot_,
                                         .flow = options.flow,
                                         .min_flow_side = options.min_flow_side,
                                         .time = source_.time},
                       [this, name] { return next_frame(name); });
}

/// \throws InputError if its time is not after that of the frame before, or far behind it.
std::span<const float> ResampledFootage::next_frame(const std::string& name) {
    constexpr double kMaxPeriods = 1 / kMinFramesPerSlot;
    const auto frame = source_.next();
    if (frame.empty() || !source_.time) return frame;
    const double time = source_.time();
    if (last_time_ && !(time > *last_time_ && time - *last_time_ <= kMaxPeriods))
        throw InputError(name, fmt::format("has a frame {:.4g} frame periods after the one before "
                                           "by its time stamps; ",
                                           time - *last_time_) +
                                   Parameter{"frames_hz"} + " leaves them out");
    last_time_ = time;
    return frame;
}

std::optional<std::int64_t> ResampledFootage::slots() const {
    if (!source_.frames || !resampler_) return source_.frames;
    if (source_.time) return {};
    return resampled_slots(*source_.frames, frames_per_slot_);
}

std::span<const float> ResampledFootage::next() {
    return resampler_ ? resampler_->next() : source_.next();
}

void ResampledFootage::skip(int slots) {
    if (!resampler_ && source_.skip) return source_.skip(slots);
    for (int i = 0; i < slots && !next().empty(); ++i) {
    }
}

}  // namespace stipple
