#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "core/flux_video.h"

namespace stipple {

/// Callbacks of methods with stages, for one block; each may be empty.
struct StageObserver {
    /// Receives the estimate at the end of a stage.
    std::function<void(std::string_view stage, const FluxVideo& estimate)> finished;
    /// Receives the value of the objective after each iteration (from 0).
    std::function<void(std::string_view stage, int iteration, double objective)> iterated;
};

/// An iteration of a block: first slot of the block, number of the tile of its frames.
struct StageStep {
    std::int64_t first_slot = 0;
    int tile = 0;
    std::string_view stage;
    int iteration = 0;
    double objective = 0;
};

/// Receives the results of the stages of a method; each may be empty. Methods without stages do not
/// call it.
struct StageSink {
    /// Receives the frames of each stage in slot order, in the format of the decoded video.
    std::function<void(std::string_view stage, std::int64_t slot, std::span<const float> frame)>
        frame;
    std::function<void(const StageStep& step)> step;
};

}  // namespace stipple
