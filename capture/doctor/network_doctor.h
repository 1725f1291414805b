#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// What this machine offers GigE Vision cameras: interfaces with address and MTU, the receive
/// buffer, whether packet sockets may be opened.
[[nodiscard]] std::vector<DoctorFinding> examine_network();

/// The receive buffer of a machine whose net.core.rmem_max is `max_bytes` (0: unknown) and that
/// may or may not open packet sockets.
[[nodiscard]] DoctorFinding judge_receive_buffer(std::int64_t max_bytes, bool packet_sockets);

/// The packets that a path of this MTU carries.
[[nodiscard]] DoctorFinding judge_mtu(const std::string& interface, int mtu);

/// One GenICam camera: the interface towards it, who controls it, the packet size, its pixel format
/// and its features. Opens it for a moment; what is wrong becomes a finding. \throws InputError if
/// the address is none.
[[nodiscard]] std::vector<DoctorFinding> examine_genicam_camera(const std::string& address);

}  // namespace stipple
