#pragma once

#include <cstdint>
#include <string>

namespace stipple {

/// Reads the GenICam description of a GigE Vision camera as Aravis will when it opens the camera,
/// but within limits: Aravis (0.8.26) trusts the size and the place that a camera names, and the
/// offsets in a zip file. `ip` in host byte order. \throws DeviceError at `address`: nothing
/// answers, or the description is not in the camera, too large, damaged or not XML.
void check_genicam_download(const std::string& address, std::uint32_t ip);

}  // namespace stipple
