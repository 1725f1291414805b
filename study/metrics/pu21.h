#pragma once

namespace stipple {

/// PU21 value of an absolute luminance in cd/m2 (variant banding_glare): equal differences are
/// about equally visible. It is 0 at 0.005 cd/m2, 256 at 100 and 595 at 10 000; luminance is
/// clamped to this range. Source: Mantiuk and Azimi, "PU21: a novel perceptually uniform encoding
/// for adapting existing quality metrics for HDR", Image Coding Symposium 2021.
[[nodiscard]] double pu21(double luminance_cd_per_m2) noexcept;

}  // namespace stipple
