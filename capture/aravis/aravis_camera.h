#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_search.h"

namespace stipple {

/// Opens a GenICam camera through Aravis: "gige:IP" (GigE Vision, IPv4) or "usb:SERIAL" (USB3
/// Vision). The IP address fixes the network interface; with a name the answer to a broadcast would
/// choose it, and the program might wait for frames at the wrong one.
/// A GigE stream has packet resend on, the largest packet size that the path carries, and a socket
/// buffer for `buffers.socket_frames` frames; if the kernel allows less, the description has a
/// warning. Missing bytes of an incomplete frame are zero, never bytes of an older frame.
/// \throws InputError, DeviceError as open_camera; DeviceError if built without Aravis.
[[nodiscard]] std::unique_ptr<Camera> open_aravis_camera(const std::string& address,
                                                         const CameraSettings& settings,
                                                         const CameraBuffers& buffers);

/// GenICam cameras that answer a broadcast within 1 s or are on the USB. \throws DeviceError if
/// built without Aravis.
[[nodiscard]] std::vector<CameraListing> list_aravis_cameras();

/// The features of the camera at an address, as far as AravisDevice::feature_names. Opens the
/// camera for a moment; another program may control it. \throws as open_aravis_camera.
[[nodiscard]] std::vector<CameraFeature> aravis_features(const std::string& address);

}  // namespace stipple
