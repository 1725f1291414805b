#pragma once

#include <span>

#include "core/plane.h"

namespace stipple {

// Dense flow between images by OpenCV: (x, y) in pixels for each pixel. OpenCV brings 200 libraries
// with it, such as GDAL and GStreamer. So it is not linked to the program but to
// libstipple_opencv.so, which is loaded at its first use. Both functions throw DeviceError if the
// library cannot be loaded from the folder of the program or of the build, and exceptions of
// OpenCV.

/// TV-L1.
void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow);

/// Dense inverse search (Kroeger et al., ECCV 2016) of linear light, for images of at least 16 x 16
/// pixels. The same flow for any number of threads. Not to be called from several threads at once.
void dis_flow(PlaneView<const float> from, PlaneView<const float> to, std::span<float> flow);
inline constexpr int kMinDisFlowSide = 16;

}  // namespace stipple
