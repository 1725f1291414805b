#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_search.h"
#include "capture/doctor/doctor_findings.h"

namespace stipple {

/// A kind of camera: the form of its addresses and its functions. A null function does not exist
/// for this kind.
struct CameraKind {
    std::string_view prefix;   ///< of its addresses, before the colon
    std::string_view address;  ///< their form, for messages
    bool is_replay;            ///< a file: it has an end, and no other program controls it
    std::unique_ptr<Camera> (*open)(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers);
    std::vector<CameraListing> (*list)();
    /// For the camera at an address; for all cameras of the kind if it is empty.
    std::vector<DoctorFinding> (*examine_machine)(const std::string& address);
    std::vector<DoctorFinding> (*examine_camera)(const std::string& address);
    std::vector<CameraFeature> (*features)(const std::string& address) = nullptr;
};

/// All kinds. `list` of one kind may also find cameras of a later kind.
[[nodiscard]] std::span<const CameraKind> camera_kinds();

/// The kind of the camera at an address. \throws InputError if there is none.
[[nodiscard]] const CameraKind& camera_kind(std::string_view address);

/// The forms of addresses, for messages: "gige:IP, usb:SERIAL ... or replay:FILE".
[[nodiscard]] std::string address_forms();

}  // namespace stipple
