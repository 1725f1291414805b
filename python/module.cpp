#include <pybind11/pybind11.h>

#include "core/version.h"

namespace py = pybind11;

PYBIND11_MODULE(_stipple, module) {
    module.doc() = "The compiled part of the package stipple.";
    module.attr("__version__") = stipple::version();
}
