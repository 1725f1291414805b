#pragma once

#include <functional>
#include <optional>

#include "core/flux_video.h"
#include "decoder/stage_observer.h"

namespace stipple {

struct Measurements;

/// A decoder of one plane; nothing if it was stopped.
using PlaneDecoder = std::function<std::optional<FluxVideo>(const Measurements& measurements,
                                                            const StageObserver& observer)>;

/// Decodes a mosaic by a method for grey video: the ratios of the colours of each voxel are those
/// of the nearest samples, and the method finds its mean (R + G + B) / 3. A sample is then a sum of
/// the mean, weighted by the ratio of its colour to the mean in each voxel of its exposure. Stages
/// are told in colour. Precondition: measurements.mosaic.
[[nodiscard]] std::optional<FluxVideo> decode_by_hue(const Measurements& measurements,
                                                     const StageObserver& observer,
                                                     const PlaneDecoder& decode);

}  // namespace stipple
