#pragma once

namespace stipple {

struct Measurements;

/// Merges exposures of the same slots of a site, which several sensors have: the mean of their
/// samples, weighted by their inverse variances, becomes a sample of the sensor that comes first,
/// and those of the others are removed. The weights are taken at the mean light of the samples
/// (that of the pooled photons), so that they hardly depend on the noise of one; with them fixed
/// the noise of the mean is exact. A saturated sample gives way to one that is not; of saturated
/// ones the highest bound remains. Sensors whose samples are all merged are removed from
/// `measurements.others`. Weighted exposures (grey masks) are left alone. The same bits for any
/// thread count.
void merge_equal_exposures(Measurements& measurements);

}  // namespace stipple
