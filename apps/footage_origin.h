#pragma once

#include <string>

#include "io/footage_reader.h"

namespace stipple {

/// Where light comes from and how its numbers were read: what a stream says of its footage.
struct FootageOrigin {
    std::string name = {};       ///< without folders
    std::string sha256 = {};     ///< of its files, one after the other; empty where there are none
    std::string recording = {};  ///< tells recordings of one camera apart; empty of files
    FootageOptions reading = {};
    double black_level_dn = 0;  ///< that was taken off a recording
};

/// The origin of footage that lies in files: those of a folder or pattern in the order of frames.
/// Reads them all. \throws InputError if one cannot be read, Interrupted.
[[nodiscard]] FootageOrigin origin_of(const std::string& footage, const FootageOptions& reading);

}  // namespace stipple
