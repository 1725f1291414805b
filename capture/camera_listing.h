#pragma once

#include <string>
#include <vector>

namespace stipple {

/// A camera that was found.
struct CameraListing {
    std::string address;    ///< argument of open_camera
    std::string transport;  ///< as in CameraDescription
    std::string vendor;
    std::string model;
    std::string serial;
};

/// Cameras found, and the kinds of cameras that could not be searched, each with the reason.
struct CameraSearch {
    std::vector<CameraListing> cameras;
    std::vector<std::string> problems;
};

/// Searches all kinds of cameras. Takes about a second, the time for GigE Vision cameras to answer.
[[nodiscard]] CameraSearch list_cameras();

}  // namespace stipple
