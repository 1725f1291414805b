#pragma once

#include <pybind11/pybind11.h>

#include "decoder/learned/learned.h"

namespace stipple::python {

/// A function of Python as refiner: call(inputs) gives v, an array (row, col) of float32,
/// C-contiguous, for inputs (input, row, col). With the GIL. \throws what the function raises.
[[nodiscard]] Refiner python_refiner(const pybind11::object& call);

}  // namespace stipple::python
