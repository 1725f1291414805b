#include "apps/recording_faults.h"

#include <fmt/format.h>

#include "core/joined.h"

namespace stipple {

std::string recording_faults(const std::string& file, const RecordingFootage& footage) {
    auto faults = footage.recording().faults();
    if (footage.missing_frames() > 0)
        faults.push_back(fmt::format(
            "lacks {} frames that are missing or incomplete (the one before stands in for {})",
            footage.missing_frames(), footage.held_slots()));
    if (faults.empty()) return {};
    return fmt::format("{}: {}; `stipple capture replay` lists the places", file, joined(faults));
}

}  // namespace stipple
