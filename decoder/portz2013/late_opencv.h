#pragma once

#include <span>

#include "core/plane.h"

namespace stipple {

/// Dense flow between images by OpenCV's TV-L1: (x, y) in pixels for each pixel. OpenCV brings 200
/// libraries with it, such as GDAL and GStreamer. So it is not linked to the program but to
/// libstipple_opencv.so, which is loaded at its first use.
/// \throws DeviceError if the library cannot be loaded from the folder of the program or of the
/// build; exceptions of OpenCV.
void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow);

}  // namespace stipple
