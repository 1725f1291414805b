#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "core/flux_video.h"

namespace stipple {

/// What methods that work in stages tell of a block; either may be empty.
struct StageObserver {
    /// The estimate that a stage has come to.
    std::function<void(std::string_view stage, const FluxVideo& estimate)> finished;
    /// What is minimised, after each iteration (from 0 on).
    std::function<void(std::string_view stage, int iteration, double objective)> iterated;
};

/// An iteration of a block: the block's first slot, which of the tiles of its frames it is.
struct StageStep {
    std::int64_t first_slot = 0;
    int tile = 0;
    std::string_view stage;
    int iteration = 0;
    double objective = 0;
};

/// Takes what the stages of a method come to; either may be empty. Methods without stages tell
/// nothing.
struct StageSink {
    /// The frames of each stage, in slot order; as those of the decoded video.
    std::function<void(std::string_view stage, std::int64_t slot, std::span<const float> frame)>
        frame;
    std::function<void(const StageStep& step)> step;
};

}  // namespace stipple
