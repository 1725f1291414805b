#pragma once

#include <array>
#include <cstdint>

#include "capture/camera.h"
#include "capture/frame_record.h"

namespace stipple {

/// Frames that are missing before the next one, by cause.
struct FrameGap {
    std::array<std::uint64_t, kGapCauseNames.size()> lost{};

    void add(GapCause cause, std::uint64_t frames) {
        lost[static_cast<std::size_t>(cause)] += frames;
    }
    [[nodiscard]] std::uint64_t total() const;
    /// Of most of them.
    [[nodiscard]] GapCause cause() const;
};

/// The cause of a loss, by what the transport had counted before and after it. `incomplete_frames`:
/// whether frames have arrived incomplete meanwhile; their packets explain the loss of no others.
[[nodiscard]] GapCause cause_of(const TransportCounts& before, const TransportCounts& after,
                                bool incomplete_frames);

}  // namespace stipple
