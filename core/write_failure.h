#pragma once

#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include "core/error.h"

namespace stipple {

/// That `where` cannot be written for the reason `error` of the system (errno), with the remedy if
/// the disk is full.
[[nodiscard]] inline DeviceError write_failure(std::string_view where, int error) {
    const bool full = error == ENOSPC || error == EDQUOT;
    return {where, "cannot be written: " + std::generic_category().message(error) +
                       (full ? "; free space, or write to another disk" : "")};
}

}  // namespace stipple
