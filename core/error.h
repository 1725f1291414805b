#pragma once

#include <cerrno>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/message.h"

namespace stipple {

/// A run cannot go on. `what()` is "where: fault", with parameters as in C++; `where` names the
/// file or device and, if known, the key or byte offset, `fault` also the remedy.
class Error : public std::runtime_error {
  public:
    Error(Message where, Message fault)
        : std::runtime_error((where + ": " + fault).text()),
          parts_(std::make_shared<const Parts>(std::move(where), std::move(fault))) {}

    [[nodiscard]] const Message& where() const { return parts_->first; }
    [[nodiscard]] const Message& fault() const { return parts_->second; }
    [[nodiscard]] Message message() const { return where() + ": " + fault(); }

  private:
    using Parts = std::pair<Message, Message>;
    std::shared_ptr<const Parts> parts_;  ///< copies of exceptions must not throw
};

/// An input of the user (a file, an option, a key) is not usable. Exit code 1.
class InputError : public Error {
  public:
    using Error::Error;
};

/// A camera or an output device failed, for example a full disk. Exit code 3.
class DeviceError : public Error {
  public:
    using Error::Error;
};

/// That `where` cannot be written for the reason `error` of the system (errno), with the remedy if
/// the disk is full.
[[nodiscard]] inline DeviceError write_failure(std::string_view where, int error) {
    const bool full = error == ENOSPC || error == EDQUOT;
    return {where, "cannot be written: " + std::generic_category().message(error) +
                       (full ? "; free space, or write to another disk" : "")};
}

}  // namespace stipple
