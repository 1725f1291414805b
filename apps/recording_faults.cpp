#include "apps/recording_faults.h"

#include <fmt/format.h>

#include <vector>

#include "core/joined.h"

namespace stipple {

std::string recording_faults(const std::string& file, const RecordingFootage& footage) {
    const RecordingReport& report = footage.recording().report();
    std::vector<std::string> faults;
    if (!report.damage.empty())
        faults.push_back(
            fmt::format("is damaged ({} of its blocks cannot be read)", report.missing_blocks));
    if (!footage.recording().end()) faults.emplace_back("was cut off before its end");
    if (footage.missing_frames() > 0)
        faults.push_back(fmt::format(
            "lacks {} frames that are missing or incomplete (the one before stands in for {})",
            footage.missing_frames(), footage.held_slots()));
    if (faults.empty()) return {};
    return fmt::format("{}: {}; `stipple capture replay` lists the places", file, joined(faults));
}

}  // namespace stipple
