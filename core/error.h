#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace stipple {

/// An input of the user (a file, an option, a key) is not usable. `what()` is "where: problem".
/// `where` names the file and, if known, the key or byte offset; `problem` names the fault and the
/// remedy. Exit code 1.
class InputError : public std::runtime_error {
  public:
    InputError(std::string_view where, std::string_view problem)
        : std::runtime_error(std::string(where).append(": ").append(problem)) {}
};

/// A camera or an output device failed, for example a full disk. Exit code 3.
class DeviceError : public std::runtime_error {
  public:
    DeviceError(std::string_view where, std::string_view problem)
        : std::runtime_error(std::string(where).append(": ").append(problem)) {}
};

}  // namespace stipple
