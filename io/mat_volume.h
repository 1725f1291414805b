#pragma once

#include <string>

#include "io/npy_file.h"

namespace stipple {

/// The variable `name` of a MATLAB file: an array of real numbers (rows, columns) or (rows,
/// columns, layers). \throws InputError if the file cannot be read, lacks the variable, or holds
/// something else in it; and if this program was built without the library matio.
[[nodiscard]] NpyVolume read_mat_volume(const std::string& file, const std::string& name);

/// Whether a file has the extension .mat.
[[nodiscard]] bool is_mat(const std::string& file);

}  // namespace stipple
