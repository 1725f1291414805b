#include "io/video_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stipple {

FrameTimes::FrameTimes(double tick_s, std::optional<double> hz)
    : tick_s_(tick_s), ticks_a_period_(hz ? 1 / (*hz * tick_s) : 0) {}

void FrameTimes::add(std::optional<std::int64_t> tick) {
    // Of two time stamps; less than a tick, for a period may be one.
    constexpr double kRoundingTicks = 0.75;
    const auto number = static_cast<double>(frames_++);
    if (!tick) {
        time_ += 1;
        return;
    }
    if (origin_) {
        min_ticks_ = std::min(min_ticks_, *tick - last_tick_);
        max_ticks_ = std::max(max_ticks_, *tick - last_tick_);
    }
    last_tick_ = *tick;
    const auto ticks = static_cast<double>(*tick);
    if (!origin_) origin_ = ticks - number * ticks_a_period_;
    const double off_grid = ticks - *origin_ - number * ticks_a_period_;
    const bool on_grid = ticks_a_period_ == 0 || std::abs(off_grid) <= kRoundingTicks;
    time_ = on_grid ? number : (ticks - *origin_) / ticks_a_period_;
}

std::string FrameTimes::unequal() const {
    constexpr std::int64_t kRounding = 2;
    const std::int64_t allowed = std::max(kRounding, min_ticks_ / 2);
    if (max_ticks_ == 0 || max_ticks_ - min_ticks_ <= allowed) return {};
    return fmt::format("{:.4g} to {:.4g} s apart", static_cast<double>(min_ticks_) * tick_s_,
                       static_cast<double>(max_ticks_) * tick_s_);
}

}  // namespace stipple
