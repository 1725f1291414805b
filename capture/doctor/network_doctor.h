#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// Network of this machine for the GigE Vision camera at "gige:IP", for all such cameras if the
/// address is empty: the interfaces that lead there with address and MTU, receive buffer,
/// permission for a larger one.
[[nodiscard]] std::vector<DoctorFinding> examine_network(const std::string& address);

/// Finding on the receive buffer for a net.core.rmem_max of `max_bytes` (0: unknown), which this
/// program may exceed or not.
[[nodiscard]] DoctorFinding judge_receive_buffer(std::int64_t max_bytes, bool may_exceed);

/// Finding on the packet size that a path of this MTU carries.
[[nodiscard]] DoctorFinding judge_mtu(const std::string& interface, int mtu);

/// Findings on one GenICam camera: network interface, controlling program, packet size, pixel
/// format, features. Opens the camera for a moment; errors become findings. \throws InputError if
/// the address is none.
[[nodiscard]] std::vector<DoctorFinding> examine_genicam_camera(const std::string& address);

}  // namespace stipple
