#pragma once

#include <cstdint>
#include <optional>

#include "capture/frame_record.h"

namespace stipple {

/// The rate of a camera's frames, lost ones counted: the periods between the first frame and the
/// last one over the time between them, by the device's stamps or else by their arrival. Measured
/// anew after an outage.
class FrameRate {
  public:
    void add(const FrameRecord& record);

    /// From the first frame to the last one.
    [[nodiscard]] double seconds() const;
    [[nodiscard]] std::uint64_t periods() const;
    /// Nothing until two frames have come.
    [[nodiscard]] std::optional<double> hz() const;

  private:
    std::optional<FrameRecord> first_;
    FrameRecord last_;
};

}  // namespace stipple
