#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/plane.h"

namespace stipple {

struct FilmFormat {
    int rows = 0;
    int cols = 0;
    double frames_per_second = 0;
};

/// Takes the next frame of a film, rows of (blue, green, red). The film ends with its last copy.
using FilmFrames = std::function<void(std::span<std::uint8_t>)>;

/// What OpenCV does in libraries that bring 200 others with them, GDAL and GStreamer among them.
/// They are no part of the program but of libstipple_opencv.so, which is loaded at the first use: a
/// start takes a third of the time. Its functions throw what OpenCV throws.
struct LateOpenCv {
    /// Nothing if no codec can write such a film there.
    FilmFrames (*create_film)(const std::string& file, const FilmFormat& format);
    /// Dense flow from image to image by TV-L1: (x, y) in pixels for each pixel.
    void (*tv_l1_flow)(PlaneView<float> from, PlaneView<float> to, std::span<float> flow);
};

/// \throws DeviceError if the library cannot be loaded, from beside the program or where it was
/// built.
[[nodiscard]] const LateOpenCv& late_opencv();

}  // namespace stipple
