#pragma once

#include "core/progress.h"
#include "decoder/stage_observer.h"

namespace stipple {

struct Calibration;
struct DecodeOptions;
struct Measurements;
struct StageObserver;

/// A block of the video and the context of its decoding.
struct BlockTask {
    Measurements& measurements;  ///< a method may change them
    const Calibration& calibration;
    const DecodeOptions& options;
    const ProgressCallback& progress;
    const StageObserver& observer;
};

}  // namespace stipple
