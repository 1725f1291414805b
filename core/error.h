#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace stipple {

/// Something the user gave (a file, an option, a key) cannot be used. `what()` reads
/// "place: problem", where place names the file and, where known, the key or byte offset, and
/// problem says what is wrong and what to do. Exit code 1.
class InputError : public std::runtime_error {
  public:
    InputError(std::string_view place, std::string_view problem)
        : std::runtime_error(std::string(place).append(": ").append(problem)) {}
};

/// A camera or an output device (a full disk, say) failed. Exit code 3.
class DeviceError : public std::runtime_error {
  public:
    DeviceError(std::string_view place, std::string_view problem)
        : std::runtime_error(std::string(place).append(": ").append(problem)) {}
};

}  // namespace stipple
