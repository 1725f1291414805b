#pragma once

#include <cstdint>
#include <span>

#include "decoder/data_prox.h"

namespace stipple {

struct Measurements;

/// Slots [begin, end) of a block, from whose samples those of [core_begin, core_end) are decoded.
/// Exposures that reach beyond the window are unobserved.
struct LiveWindow {
    static constexpr int kMaxSlots = 24;

    int begin = 0;
    int core_begin = 0;
    int core_end = 0;
    int end = 0;

    [[nodiscard]] int slots() const { return end - begin; }
};

/// Sites of a window, all of one plane: one of site_runs.
struct WindowRun {
    const Measurements& measurements;
    LiveWindow window;
    SiteRun sites;
};

/// Slots [begin, end) of a block.
struct WindowSlots {
    int begin = 0;
    int end = 0;
};

/// The residuals of a window's exposures, spread over their open voxels; 0 where none is open. Both
/// of order (slot, plane, row, col) from slot `begin` of the window.
struct SpreadResiduals {
    std::span<float> precision;  ///< 1 / variance, in 1 / light^2
    std::span<float> weighted;   ///< residual times precision, in 1 / light
};

/// The mean light of each site along time: in `light`, order as SpreadResiduals. An exposure that
/// is not saturated has the weight n l^d, n the sum of the weights of its open slots, d the
/// distance of a slot from its last one. l is exp(-1 / 16) where 80 % of the exposed slots are in
/// such exposures, and falls linearly with this fraction, to exp(-1 / 1.5) at 0. If all exposures
/// are saturated, the mean is their highest bound. It is not negative. `known` has a value per
/// site: 0 if the window has no sample of it (then the light is 0), 1 if all are saturated, else 2.
/// The same bits for any SIMD target, as of the functions below. Precondition of all:
/// window.slots() <= LiveWindow::kMaxSlots.
void average_in_time(const WindowRun& run, std::span<float> light,
                     std::span<std::uint8_t> known) noexcept;

/// Residuals (y - A x) / n of the light per slot, in `slots` of the window. A saturated exposure
/// whose bound is exceeded has no precision. The variance is that of the sample, and the square of
/// 0.11 (n - 1) of the mean light, of 0.03 at least: what motion may make of a slot of a long
/// exposure.
void spread_residuals(const WindowRun& run, const WindowSlots& slots, std::span<const float> light,
                      const SpreadResiduals& residuals) noexcept;

/// The core of a window: the light after a step of data consistency (data_prox.h), with step sizes
/// proportional to the light and shrunk by r^2 / (r^2 + 3 var), r = y - A x: where the sample
/// agrees within its noise, the light stays. `result` has the slots of the core, order (slot,
/// plane, row, col).
void restore_sums(const WindowRun& run, std::span<const float> light,
                  std::span<float> result) noexcept;

}  // namespace stipple
