#include "python/refiner.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/error.h"
#include "decoder/learned/refinement_inputs.h"

namespace stipple::python {
namespace py = pybind11;

Refiner python_refiner(const py::object& call) {
    // Deleted with the GIL.
    const std::shared_ptr<py::object> held(new py::object(call), [](py::object* last) {
        const py::gil_scoped_acquire gil;
        delete last;
    });
    return [held](const RefinerInput& input, std::span<float> refined) {
        const py::gil_scoped_acquire gil;
        py::array_t<float> inputs({kRefinementInputs, input.rows, input.cols});
        std::ranges::copy(input.inputs, inputs.mutable_data());
        const auto result = (*held)(inputs).cast<py::array_t<float, py::array::c_style>>();
        if (static_cast<std::size_t>(result.size()) != refined.size())
            throw InputError("refiner", "its result has another size");
        std::copy_n(result.data(), refined.size(), refined.begin());
    };
}

}  // namespace stipple::python
