#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace stipple {

/// The figures that `stipple characterize --json FILE` has written: the keys of camera_json that a
/// report shows. \throws InputError if the file cannot be read or holds something else.
[[nodiscard]] nlohmann::ordered_json read_camera_file(const std::string& file);

}  // namespace stipple
