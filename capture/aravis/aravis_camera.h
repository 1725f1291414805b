#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_listing.h"

namespace stipple {

/// Opens a GenICam camera through Aravis: "gige:IP" (GigE Vision, IPv4) or "usb:SERIAL" (USB3
/// Vision). Opening by IP rather than by name fixes the network interface: with names the answer to
/// a broadcast picks it, and frames may then be awaited where none arrive.
/// A GigE stream has resend on, the packet size that the path carries, and a socket buffer for
/// `buffers.frames` frames, as far as the kernel allows (else a warning in the description).
/// Buffers are cleared before each use, so an incomplete frame has zeros, never bytes of an older
/// one, where packets are missing.
/// \throws InputError, DeviceError as open_camera; DeviceError if built without Aravis.
[[nodiscard]] std::unique_ptr<Camera> open_aravis_camera(const std::string& address,
                                                         const CameraSettings& settings,
                                                         const CameraBuffers& buffers);

/// GenICam cameras that answer a broadcast (1 s) or are on the USB. \throws DeviceError if built
/// without Aravis.
[[nodiscard]] std::vector<CameraListing> list_aravis_cameras();

}  // namespace stipple
