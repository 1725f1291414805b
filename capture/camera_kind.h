#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_listing.h"
#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// A kind of camera: how its addresses look, and what can be done with one. A function that is null
/// is not there for this kind.
struct CameraKind {
    std::string_view prefix;   ///< of its addresses, before the colon
    std::string_view address;  ///< its form, for people
    bool is_replay;            ///< of a file: it has an end, and nobody else has it open
    std::unique_ptr<Camera> (*open)(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers);
    std::vector<CameraListing> (*list)();
    std::vector<DoctorFinding> (*examine_machine)();  ///< for all cameras of the kind
    std::vector<DoctorFinding> (*examine_camera)(const std::string& address);
};

/// Every kind there is. A listing may find cameras of a later kind too.
[[nodiscard]] std::span<const CameraKind> camera_kinds();

/// The kind of the camera that an address names. \throws InputError if none.
[[nodiscard]] const CameraKind& camera_kind(std::string_view address);

/// The forms of addresses, for people: "gige:IP, usb:SERIAL ... or replay:FILE".
[[nodiscard]] std::string address_forms();

}  // namespace stipple
