#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace stipple {

/// When the frames of a video are shown, by their time stamps in ticks.
class FrameTimes {
  public:
    /// Times are in periods of the rate `hz`. Without a rate frame j is at j.
    explicit FrameTimes(double tick_s = 1, std::optional<double> hz = {});

    /// The next frame, with its time stamp if it has one.
    void add(std::optional<std::int64_t> tick);

    /// Of the last frame, from the first one on: its number, unless its time stamp differs from
    /// that by more than rounding.
    [[nodiscard]] double time() const { return time_; }
    /// "0.03 to 0.1 s apart"; empty if the frames are equally far apart but for rounding.
    [[nodiscard]] std::string unequal() const;

  private:
    double tick_s_;
    double ticks_a_period_;  ///< 0: unknown
    std::int64_t frames_ = 0;
    std::optional<double> origin_;  ///< tick of the first frame
    std::int64_t last_tick_ = 0;
    std::int64_t min_ticks_ = std::numeric_limits<std::int64_t>::max();  ///< between frames
    std::int64_t max_ticks_ = 0;
    double time_ = -1;
};

}  // namespace stipple
