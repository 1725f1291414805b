#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace stipple::python {

/// A dict of the figures that `visit(add)` adds, in their order: the functions `visit_..._figures`
/// of the libraries.
template <typename Visit>
[[nodiscard]] pybind11::dict dict_of(const Visit& visit) {
    pybind11::dict dict;
    visit([&](const char* name, const auto& value) { dict[name] = value; });
    return dict;
}

}  // namespace stipple::python
