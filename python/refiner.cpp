#include "python/refiner.h"

#include <pybind11/numpy.h>

#include <algorithm>

#include "core/error.h"
#include "decoder/learned/refinement_inputs.h"
#include "python/with_gil.h"

namespace stipple::python {
namespace py = pybind11;

Refiner python_refiner(const py::object& call) {
    const auto held = with_gil(new py::object(call));
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
