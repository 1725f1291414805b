#pragma once

#include <span>

namespace stipple {

class SampleNoise;
struct Measurements;

// The sampling operator A of y = A x + noise: one row per exposure, with the weight of each
// of its open voxels, 1 without weights. Rows share no voxel, so A A^T is diagonal and holds the
// sum of the squared weights. Arrays are those of Measurements; a row is stored at its last voxel.
// The same bits for any thread count.

/// sums = A x. Entries that end no exposure become 0.
void sample(const Measurements& measurements, std::span<const float> x, std::span<float> sums);

/// x = A^T sums: each open voxel takes its weight times the value of its exposure, others 0.
void spread(const Measurements& measurements, std::span<const float> sums, std::span<float> x);

/// Sets each variance to that of the light of its exposure in the estimate x, which has less noise
/// than the sample. Of all sensors.
void refresh_variances(Measurements& measurements, const SampleNoise& noise,
                       std::span<const float> x);

}  // namespace stipple
