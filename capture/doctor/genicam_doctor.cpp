#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "capture/aravis/aravis_call.h"
#include "capture/aravis/aravis_device.h"
#include "capture/doctor/doctor_findings.h"
#include "capture/network.h"
#include "core/error.h"
#include "io/pixel_format.h"

namespace stipple {
namespace {

using Level = DoctorFinding::Level;

void examine_path(const std::string& ip, std::vector<DoctorFinding>& findings) {
    const auto interface = interface_towards(ip);
    if (!interface) {
        findings.push_back({Level::kProblem, "path", fmt::format("no interface leads to {}", ip),
                            "give an interface an address of the camera's subnet"});
        return;
    }
    findings.push_back(
        {Level::kGood, "path",
         fmt::format("by {} from {}", interface->name, ipv4_text(interface->address)), ""});
}

void examine_control(const AravisDevice& device, std::vector<DoctorFinding>& findings) {
    if (device.is_controller()) {
        findings.push_back({Level::kGood, "control", "free", ""});
        return;
    }
    const std::string who = device.controller();
    findings.push_back({Level::kProblem, "control",
                        fmt::format("held by {}", who.empty() ? "another program" : who),
                        "stop that program, or wait some seconds if it has crashed"});
}

void examine_packets(const AravisDevice& device, std::vector<DoctorFinding>& findings) {
    auto* camera = static_cast<ArvCamera*>(device.native());
    GlibError error;
    const auto before = arv_camera_gv_get_packet_size(camera, error.slot());
    error.check_answer(device.address());
    const auto size = arv_camera_gv_auto_packet_size(camera, error.slot());
    error.check_answer(device.address());
    findings.push_back({Level::kGood, "packet size",
                        size == before
                            ? fmt::format("{} bytes; the probe found no better one", size)
                            : fmt::format("{} bytes by probing, {} before", size, before),
                        ""});
}

void examine_format(const AravisDevice& device, std::vector<DoctorFinding>& findings) {
    auto* camera = static_cast<ArvCamera*>(device.native());
    GlibError error;
    const auto code = static_cast<std::uint32_t>(arv_camera_get_pixel_format(camera, error.slot()));
    error.check_answer(device.address());
    const PixelFormat* format = pixel_format_of_pfnc(code);
    if (format != nullptr) {
        findings.push_back({Level::kGood, "pixel format", std::string(format->name), ""});
        return;
    }
    findings.push_back({Level::kWarning, "pixel format", fmt::format("0x{:08x} is not read", code),
                        "set another PixelFormat of the camera when recording"});
}

/// \throws DeviceError.
void examine(const std::string& address, std::vector<DoctorFinding>& findings) {
    const AravisDevice device(address);
    findings.push_back({Level::kFact, "camera",
                        fmt::format("{} {}", device.read("DeviceVendorName").value_or("?"),
                                    device.read("DeviceModelName").value_or("?")),
                        ""});
    examine_control(device, findings);
    if (device.is_gige() && device.is_controller()) examine_packets(device, findings);
    examine_format(device, findings);
    for (const auto& [name, value] : device.features())
        findings.push_back({Level::kFact, name, value, ""});
}

std::string fact_of(const DeviceError& error) {
    std::string fact = error.what();
    if (const auto at = fact.find(kAskDoctor); at != std::string::npos)
        fact.erase(at, kAskDoctor.size());
    return fact;
}

/// What was found before the camera was lost counts too.
std::vector<DoctorFinding> examined(const std::string& address) {
    std::vector<DoctorFinding> findings;
    try {
        examine(address, findings);
    } catch (const DeviceError& e) {
        findings.push_back({Level::kProblem, "camera", fact_of(e), ""});
    }
    return findings;
}

}  // namespace

std::vector<DoctorFinding> examine_genicam_camera(const std::string& address) {
    std::vector<DoctorFinding> findings;
    if (address.starts_with("gige:")) examine_path(address.substr(5), findings);
    try {
        std::ranges::move(within_limited_time(address, [address] { return examined(address); }),
                          std::back_inserter(findings));
    } catch (const DeviceError& e) {
        findings.push_back({Level::kProblem, "camera", fact_of(e), ""});
    }
    return findings;
}

}  // namespace stipple
