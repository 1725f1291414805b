#pragma once

#include <optional>
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

/// A feature of a GenICam camera or a control of a V4L2 device, as the camera describes it now:
/// ranges and choices may depend on the values of others.
struct CameraFeature {
    std::string name = {};      ///< as `--set camera.NAME=VALUE` takes it
    std::string category = {};  ///< that lists it; empty: none
    /// integer, float, boolean, choice, text, command, mask (bits), register or unknown
    std::string type = {};
    std::string access = {};                    ///< "rw", "ro", "wo"; "na": not available now
    bool locked = false;                        ///< "ro" or "na" only while frames come
    std::optional<std::string> value = {};      ///< if it can be read
    std::string unit = {};                      ///< empty: none
    std::optional<std::string> minimum = {};    ///< of numbers, if the camera tells
    std::optional<std::string> maximum = {};    ///< likewise
    std::optional<std::string> increment = {};  ///< likewise
    std::vector<std::string> choices = {};      ///< available now
    std::string text = {};                      ///< one line from the camera; empty: none
};

/// The features of the camera at `address` whose names match `pattern`: a part of the name, or the
/// name with the wildcards * ? []; upper and lower case are equal, an empty pattern matches all.
/// \throws InputError if there is no such address, its kind of camera has no features, or none
/// matches; DeviceError if the camera does not answer.
[[nodiscard]] std::vector<CameraFeature> camera_features(const std::string& address,
                                                         const std::string& pattern);

}  // namespace stipple
