#pragma once

#include <cstdint>
#include <optional>

#include "capture/frame_record.h"

namespace stipple {

/// Frame rate of a camera, with lost frames counted: number of periods between the first and the
/// last frame over the time between them, by device stamps, or by arrival if there are none. An
/// outage restarts the measurement, and so does an id or a stamp that goes back.
class FrameRate {
  public:
    void add(const FrameRecord& record);

    /// Time from the first to the last frame.
    [[nodiscard]] double seconds() const;
    [[nodiscard]] std::uint64_t periods() const;
    /// Empty until there are two frames.
    [[nodiscard]] std::optional<double> hz() const;

  private:
    std::optional<FrameRecord> first_;
    FrameRecord last_;
};

}  // namespace stipple
