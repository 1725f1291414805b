#pragma once

#include <pybind11/pybind11.h>

#include "decoder/best/denoiser.h"

namespace stipple::python {

/// A function of Python as denoiser: call(video, sigma, step) gives the video without noise, an
/// array of float32 (slot, plane, row, col) with the sizes of `video`, C-contiguous. With the GIL,
/// which copies and calls of the result do not need. \throws what the function raises.
[[nodiscard]] DenoiserMaker python_denoiser(const pybind11::object& call);

}  // namespace stipple::python
