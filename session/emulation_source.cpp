#include "session/emulation_source.h"

#include <utility>

#include "core/error.h"
#include "decoder/motion/lazy_opencv.h"
#include "readout/footage_origin.h"

namespace stipple {

ReadAhead EmulationSource::open(std::function<void(const Message&)> warn) const {
    return ReadAhead(footage, reading, std::move(warn));
}

ResampledFootage EmulationSource::slots_of(ReadAhead& frames, double slot_us) const {
    return {frames,
            footage,
            {.method = resampling,
             .frames_hz = reading.frames_hz,
             .slot_us = slot_us,
             .flow = dis_flow,
             .min_flow_side = kMinDisFlowSide}};
}

FootageOrigin EmulationSource::origin(const std::function<void()>& check) const {
    FootageOrigin origin = origin_of(footage, reading, check);
    if (resampling) origin.resample = name_in(kResamplings, *resampling);
    return origin;
}

void refuse_short_footage(const std::string& footage) {
    throw InputError(footage, "is shorter than a slot of the sensor");
}

}  // namespace stipple
