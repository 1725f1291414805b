#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "capture/camera_kind.h"
#include "core/error.h"
#include "core/named_value.h"

namespace stipple {
namespace {

using Level = DoctorFinding::Level;
constexpr auto kLevels = std::to_array<NamedValue<Level>>({{"fact", Level::kFact},
                                                           {"good", Level::kGood},
                                                           {"warning", Level::kWarning},
                                                           {"problem", Level::kProblem}});

std::string_view name_of(Level level) {
    return name_in(kLevels, level);
}

/// The kind of the camera to look at; null if there is none.
const CameraKind* kind_of(const std::string& address) {
    if (address.empty()) return nullptr;
    const CameraKind& kind = camera_kind(address);
    if (kind.examine_camera != nullptr) return &kind;
    throw InputError(address,
                     "the doctor looks at one camera if it is gige:IP or usb:SERIAL; without an "
                     "address it looks at all V4L2 devices, and a replay needs no doctor");
}

std::vector<DoctorFinding> examine(const std::string& address) {
    const CameraKind* const asked = kind_of(address);
    std::vector<DoctorFinding> findings;
    const auto add = [&](const std::vector<DoctorFinding>& more) {
        findings.insert(findings.end(), more.begin(), more.end());
    };
    for (const CameraKind& kind : camera_kinds()) {
        if (kind.examine_machine != nullptr && (asked == nullptr || &kind == asked))
            add(kind.examine_machine(address));
        if (&kind == asked) add(kind.examine_camera(address));
    }
    return findings;
}

nlohmann::ordered_json findings_json(const std::vector<DoctorFinding>& findings) {
    auto list = nlohmann::ordered_json::array();
    for (const DoctorFinding& finding : findings)
        list.push_back({{"level", name_of(finding.level)},
                        {"subject", finding.subject},
                        {"fact", finding.fact},
                        {"fix", finding.fix}});
    return {{"findings", list}};
}

std::string findings_text(const std::vector<DoctorFinding>& findings) {
    std::string text;
    for (const DoctorFinding& finding : findings) {
        text += fmt::format("{}{:<8} {:<24} {}", text.empty() ? "" : "\n", name_of(finding.level),
                            finding.subject, finding.fact);
        if (!finding.fix.empty()) text += fmt::format("\n{:9}fix: {}", "", finding.fix);
    }
    return text;
}

void doctor(const std::string& address, const RunOptions& run) {
    JsonFile json(run);
    const std::vector<DoctorFinding> findings =
        interruptible([address] { return examine(address); });
    json.write(findings_json(findings));
    run.say(findings_text(findings));
    const auto problems = std::ranges::count(findings, Level::kProblem, &DoctorFinding::level);
    if (problems > 0)
        throw DeviceError("capture doctor", fmt::format("found {}", counted(problems, "problem")));
}

}  // namespace

void add_capture_doctor(Command& capture, Action& action) {
    Command command =
        capture.add_command("doctor", "Diagnose the network and camera settings that cost frames");
    const auto address = std::make_shared<std::string>();
    command.add_option("ADDRESS", *address,
                       "a camera to look at, and what it needs of this machine: gige:IP or "
                       "usb:SERIAL");
    command.footer(
        "Examples:\n"
        "  stipple capture doctor\n"
        "  stipple capture doctor gige:192.168.0.5");
    set_action(command, action, address, doctor);
}

}  // namespace stipple
