#pragma once

#include <string>

namespace stipple {

/// The figures that `stipple characterize --json FILE` has written, as JSON text: the keys that a
/// report shows (RunReport::set_camera). \throws InputError if the file cannot be read or holds
/// something else.
[[nodiscard]] std::string read_camera_file(const std::string& file);

}  // namespace stipple
