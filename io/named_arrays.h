#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "io/output_file.h"

namespace stipple {

/// An array with the name by which other programs find it.
struct NamedArray {
    std::string name;
    std::vector<std::size_t> shape;  ///< the last index varies fastest; empty: one number
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::uint8_t>> values;
};

/// As numpy.savez: a .npz, a ZIP archive of uncompressed .npy files. The same arrays give the same
/// bytes. \throws InputError at `where` if it would be longer than 4 GiB; DeviceError.
void write_npz(OutputFile& file, std::span<const NamedArray> arrays, const std::string& where);

/// As save of MATLAB (-v6): a MATLAB 5 file without compression. The last two sides of a shape come
/// first: (slots, rows, columns) is rows x columns x slots there. A single number is 1 x 1. \throws
/// InputError at `where` if an array is longer than 2 GiB; DeviceError.
void write_mat(OutputFile& file, std::span<const NamedArray> arrays, const std::string& where);

}  // namespace stipple
