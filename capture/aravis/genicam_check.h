#pragma once

#include <string>

namespace stipple {

/// Checks the GenICam description of the ArvDevice `device`. \throws DeviceError at `address` if
/// the value of a feature depends on itself, or on others in more than 1000 ways: Aravis (0.8.26)
/// would not terminate.
void check_genicam(void* device, const std::string& address);

}  // namespace stipple
