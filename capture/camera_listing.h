#pragma once

#include <string>
#include <vector>

namespace stipple {

/// A camera that was found.
struct CameraListing {
    std::string address;    ///< what open_camera takes
    std::string transport;  ///< as in CameraDescription
    std::string vendor;
    std::string model;
    std::string serial;
};

/// What was found, and the sources that could not be asked, each with the reason.
struct CameraSearch {
    std::vector<CameraListing> cameras;
    std::vector<std::string> problems;
};

/// Asks all sources; takes about a second, for which GigE Vision cameras are waited for.
[[nodiscard]] CameraSearch list_cameras();

}  // namespace stipple
