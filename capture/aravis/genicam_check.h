#pragma once

#include <string>

namespace stipple {

/// `device` is an ArvDevice. \throws DeviceError at `address` if the value of a feature depends, by
/// the camera's description of itself, on itself or on others in more than 1000 ways: Aravis
/// (0.8.26) would look for it without end.
void check_genicam(void* device, const std::string& address);

}  // namespace stipple
