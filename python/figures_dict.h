#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace stipple::python {

/// A dict of the figures that `visit(add)` adds, in their order: the functions `visit_..._figures`
/// of the libraries. Nested figures become a dict, a list one of dicts.
template <typename Visit>
[[nodiscard]] pybind11::dict dict_of(const Visit& visit) {
    pybind11::dict dict;
    visit([&](const char* name, const auto& value) {
        if constexpr (requires { value.items; }) {
            pybind11::list list;
            for (const auto& item : value.items)
                list.append(dict_of([&](const auto& add) { value.visit(item, add); }));
            dict[name] = list;
        } else if constexpr (requires { value.visit; }) {
            dict[name] = dict_of(value.visit);
        } else {
            dict[name] = value;
        }
    });
    return dict;
}

}  // namespace stipple::python
