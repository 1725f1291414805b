#pragma once

#include <cstddef>
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
        : std::runtime_error(std::string(where).append(": ").append(problem)),
          where_bytes_(where.size()) {}

    [[nodiscard]] std::string_view where() const {
        return std::string_view(what()).substr(0, where_bytes_);
    }

  private:
    std::size_t where_bytes_;  ///< of what(); a text of its own could throw when it is copied
};

/// A camera or an output device failed, for example a full disk. Exit code 3.
class DeviceError : public std::runtime_error {
  public:
    DeviceError(std::string_view where, std::string_view problem)
        : std::runtime_error(std::string(where).append(": ").append(problem)) {}
};

}  // namespace stipple
