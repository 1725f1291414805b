#pragma once

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// The bytes of `values` as they lie in memory.
template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
    std::string bytes(values.size() * sizeof(Value), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// A version 1.0 .npy file with any dictionary and data.
inline std::string npy_with_dictionary(std::string dictionary, std::string_view data) {
    dictionary.resize((dictionary.size() + 10 + 64) / 64 * 64 - 10 - 1, ' ');
    dictionary += '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += static_cast<char>(dictionary.size() % 256);
    file += static_cast<char>(dictionary.size() / 256);
    return file.append(dictionary).append(data);
}

/// A .npy file as numpy writes it, e.g. npy_file("<u2", "(1, 2, 3)", data).
inline std::string npy_file(std::string_view descr, std::string_view shape, std::string_view data) {
    return npy_with_dictionary(
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", descr, shape),
        data);
}

}  // namespace stipple
