#pragma once

#include <span>

#include "core/plane.h"

namespace stipple {

/// Dense flow from image to image by OpenCV's TV-L1: (x, y) in pixels for each pixel. It brings 200
/// libraries with it, GDAL and GStreamer among them, so it is no part of the program but of
/// libstipple_opencv.so, which is loaded at the first use.
/// \throws DeviceError if that cannot be loaded, from beside the program or where it was built;
/// what OpenCV throws.
void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow);

}  // namespace stipple
