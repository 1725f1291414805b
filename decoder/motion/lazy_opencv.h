#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/plane.h"

namespace stipple {

// Dense flow between images by OpenCV: (x, y) in pixels for each pixel; and its networks. OpenCV
// brings 200 libraries with it, such as GDAL and GStreamer. So it is not linked to the program but
// to libstipple_opencv.so, which is loaded at its first use. All functions throw DeviceError if the
// library cannot be loaded from the folder of the program or of the build, and exceptions of
// OpenCV.

/// TV-L1.
void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow);

/// Dense inverse search (Kroeger et al., ECCV 2016) of linear light, for images of at least 16 x 16
/// pixels. The same flow for any number of threads. Not to be called from several threads at once.
void dis_flow(PlaneView<const float> from, PlaneView<const float> to, std::span<float> flow);
inline constexpr int kMinDisFlowSide = 16;

/// A network that makes an image of `channels`, so many images of the same size, one after the
/// other. For one thread at a time. \throws std::runtime_error with the reason if the network does
/// not take or give these shapes.
using ImageNetwork = std::function<void(std::span<const float> channels, PlaneView<float> image)>;

/// Of the bytes of an ONNX file. \throws std::runtime_error with the reason if they are none.
[[nodiscard]] ImageNetwork open_network(std::span<const std::uint8_t> onnx);

/// Has OpenCV use one thread and print nothing, in this process, during its lifetime.
class QuietOpenCv {
  public:
    QuietOpenCv() { swap_settings(); }
    ~QuietOpenCv() { swap_settings(); }
    QuietOpenCv(const QuietOpenCv&) = delete;
    QuietOpenCv& operator=(const QuietOpenCv&) = delete;

  private:
    void swap_settings();

    int threads_ = 1;
    int log_level_ = 0;
};

}  // namespace stipple
