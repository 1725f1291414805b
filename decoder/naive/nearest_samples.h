#pragma once

#include <cstdint>
#include <span>

#include "core/flux_video.h"

namespace stipple {

struct Measurements;

/// The estimate without a model of the scene, and the start of all other methods. Each voxel is the
/// weighted mean of the light per slot of its own exposure and of the shorter exposures of its
/// pixel around it; a voxel without an exposure takes all exposures around. An exposure with n open
/// slots (with weights: whose weights have the sum n) at a distance of d slots has the weight
/// exp(-d / 1.5) / (0.3 + n). A saturated exposure has no weight, but the mean is at least the
/// bound of the voxel's own exposure. If all exposures within 8 slots are saturated, the estimate
/// is their highest bound. So the frames of a conventional camera are held during their exposure
/// and interpolated between exposures. Sites without any sample, such as two of three colours under
/// a colour filter, are interpolated from their surroundings (fill_unsampled). Without any
/// sample the video is 0. Of several sensors: joint_nearest_samples.
[[nodiscard]] FluxVideo nearest_samples(const Measurements& measurements);

/// exp(-d / 1.5) at a distance of d slots, constant from 16 on. Precondition: d >= 0.
[[nodiscard]] float temporal_weight(int distance_slots) noexcept;

/// Saturated exposures further away are no bound.
inline constexpr int kNearSlots = 8;

/// `nearest_samples` of several sensors (Measurements::others). Each voxel is the weighted mean of
/// the light per slot of the exposures of all sensors that include its slot, and of shorter ones
/// around it; a voxel without an exposure takes all around. The weight of an exposure with n open
/// slots, d slots away, is exp(-d / 1.5) / ((0.3 + n) n var), var the variance of its light per
/// slot: n var does not depend on n where shot noise prevails, so that sensors count by their
/// photons. Saturated exposures have no weight, but if all that include the slot are saturated, the
/// mean is at least their highest bound.
[[nodiscard]] FluxVideo joint_nearest_samples(const Measurements& measurements);

/// Fills the sites without samples (`sampled` is 0; order (plane, row, col)) from their
/// surroundings, slot by slot. The guide is the plane with the most samples. In it a site becomes
/// the weighted mean of its known neighbours of 8, with weights 2 along rows and columns and 1
/// along diagonals; then the sites around it follow. If the four nearest neighbours are known and
/// another plane measures the pixel, the interpolation follows the row or the column, whichever
/// varies less, with the curvature of that plane (Hamilton and Adams, US 5629734). The other planes
/// become the guide plus their difference from it, which is interpolated in the same way: on a
/// colour filter array, bilinear interpolation of R - G and B - G. Filled values are not negative.
/// A plane without any sample equals the guide.
void fill_unsampled(std::span<const std::uint8_t> sampled, FluxVideo& x);

}  // namespace stipple
