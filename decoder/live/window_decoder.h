#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decoder/live/exposure_kernels.h"

namespace stipple {

struct Measurements;

/// Slots that are decoded from one window.
inline constexpr int kLiveCoreSlots = 8;

/// The window in which `decode_live` decodes a slot of a block of `slots` slots: 8 slots before the
/// core and 8 after it, or at the end of the block more before it.
[[nodiscard]] LiveWindow live_window(int slot, int slots);

/// The steps of `decode_live` in a window, in memory that is kept from one to the next.
class WindowDecoder {
  public:
    /// Slots of the core of a window. No exposure spans more than `longest_span_slots`.
    struct Wanted {
        WindowSlots slots;
        int longest_span_slots = LiveWindow::kMaxSlots;
    };
    /// Decodes slots of a window, order (slot, plane, row, col); the same bits as with the whole
    /// core. `known` is that of average_in_time. The pairs of rows and columns that the coarse step
    /// bins begin with the even ones. A row depends on those up to kReachRows away.
    void decode(const Measurements& measurements, const LiveWindow& window, const Wanted& wanted,
                std::span<std::uint8_t> known, std::span<float> result);

    /// 2 rows by the fine step; 1 by the interpolation and 2 by the blur of the coarse one, of two
    /// rows each.
    static constexpr int kReachRows = 8;

  private:
    // Order (slot of the window, plane, row, col).
    std::vector<float> light_;
    std::vector<float> precision_;
    std::vector<float> weighted_;
};

}  // namespace stipple
