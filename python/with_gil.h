#pragma once

#include <pybind11/pybind11.h>

#include <memory>

namespace stipple::python {

/// Holds what has Python objects, and deletes it with the GIL.
template <typename Held>
[[nodiscard]] std::shared_ptr<Held> with_gil(Held* held) {
    return {held, [](Held* last) {
                const pybind11::gil_scoped_acquire gil;
                delete last;
            }};
}

}  // namespace stipple::python
