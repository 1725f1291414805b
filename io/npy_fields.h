#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// The three entries of a .npy header, e.g. {'descr': '<f4', 'fortran_order': False,
/// 'shape': (2, 3, 4), }.
struct NpyFields {
    std::string descr;
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
};

/// Reads the Python dictionary of a .npy header, entries in any order.
/// \throws InputError at `where` if it is malformed or an entry is missing or unknown.
[[nodiscard]] NpyFields read_npy_fields(std::string_view dictionary, std::string_view where);

}  // namespace stipple
