#pragma once

#include <string>

namespace stipple {

/// The .npy file of a dictionary of one atom (3, `second`), of 2 slots and 1 pixel. `second` is one
/// digit.
inline std::string dictionary_bytes(int second) {
    std::string bytes("\x93NUMPY\x01\x00\x76\x00", 10);  // version 1.0, 118 bytes of header
    bytes += "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2, 1), }";
    bytes.resize(10 + 118 - 1, ' ');
    bytes += "\n\x03";
    bytes += static_cast<char>(second);
    return bytes;
}

}  // namespace stipple
