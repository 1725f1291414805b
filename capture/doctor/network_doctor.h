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

/// net.core.rmem_max: the largest receive buffer that a program may request, in bytes; 0 if
/// unknown.
[[nodiscard]] std::int64_t rmem_max_bytes();

/// Whether this program may have a receive buffer above net.core.rmem_max (CAP_NET_ADMIN).
[[nodiscard]] bool can_exceed_rmem_max();

/// Datagrams dropped by the full UDP socket bound to `port`; 0 if there is no such socket.
[[nodiscard]] std::uint64_t udp_drops(int port);

/// Number of dropped or damaged frames of an interface plus its link changes.
[[nodiscard]] std::uint64_t link_faults(const std::string& interface);

}  // namespace stipple
