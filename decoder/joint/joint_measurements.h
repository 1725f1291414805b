#pragma once

#include <cstdint>
#include <span>

#include "core/homography.h"
#include "stream/stream_header.h"

namespace stipple {

struct Measurements;
struct SamplePacket;
struct VideoWindow;

/// Where and when a sensor of a rig sees the scene, relative to the first one.
struct SensorView {
    Homography from_reference = {};  ///< places of the first sensor to those of this one
    std::int64_t phase_slots = 0;    ///< slots of the first sensor before its slot 0
};

/// What a sensor has said so far.
struct SensorSamples {
    const StreamHeader& header;
    std::span<const SamplePacket> packets;
    SensorView view;
};

/// The samples of all sensors in a window of the first one. A pixel of the window takes the
/// exposures of the pixel of each sensor that is nearest to its place there, and none beyond its
/// frame: exact for whole-pixel offsets, otherwise up to half a pixel wrong (docs/rig.md).
/// Exposures of the same slots are merged (joint_measurements.h). For one sensor as
/// `collect_measurements`. \throws InputError likewise. Precondition: the decoded shapes are equal.
[[nodiscard]] Measurements collect_joint(std::span<const SensorSamples> sensors,
                                         const VideoWindow& window);

/// The calibration of one sensor with the photons of all, and the noise of their weighted mean; for
/// one sensor its own in `slot`.
[[nodiscard]] Calibration joint_calibration(std::span<const SensorSamples> sensors,
                                            std::int64_t slot);

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
