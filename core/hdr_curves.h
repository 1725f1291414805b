#pragma once

#include <span>

namespace stipple {

// The curves of HDR video, ITU-R BT.2100-2. Luminance is in cd/m2, signals are 0..1.

/// Luminance of a diffuse white surface in HDR video: HDR Reference White of ITU-R BT.2408-4.
inline constexpr double kReferenceWhiteCd = 203;
/// The largest luminance of PQ.
inline constexpr double kPqMaxCd = 10'000;

/// PQ (SMPTE ST 2084): inverse EOTF of table 4. 100 cd/m2 becomes 0.508. Luminance is clipped to
/// 0..kPqMaxCd.
[[nodiscard]] float pq_signal(float cd);
/// PQ: EOTF of table 4, the inverse of pq_signal. Signals above 1 count as 1, those below 0 as 0.
[[nodiscard]] float pq_luminance(float signal);

/// HLG (ARIB STD-B67): OETF of table 5. Scene light 1/12 becomes 0.5. Light is clipped to 0..1.
[[nodiscard]] float hlg_signal(float light);
/// HLG: inverse OETF of table 5. Signals above 1 count as 1, those below 0 as 0.
[[nodiscard]] float hlg_light(float signal);
/// HLG: the scene light that the reference display of 1000 cd/m2 shows as `cd`, by its OOTF of
/// gamma 1.2 (table 5). kReferenceWhiteCd becomes 0.265, whose signal is 0.75.
[[nodiscard]] double hlg_light_of_luminance(double cd);

/// Inverse OETF of ITU-R BT.709-6 (and of BT.2020 for SDR): the light before the camera.
[[nodiscard]] float bt709_light(float signal);

/// Linear R, G, B from the primaries of BT.709 to those of BT.2020 and back, in place: three planes
/// one after the other. ITU-R BT.2087-0, with more digits. Back, light outside BT.709 becomes 0.
void bt709_to_bt2020(std::span<float> planes);
void bt2020_to_bt709(std::span<float> planes);

}  // namespace stipple
