#include "apps/recording_faults.h"

#include <fmt/format.h>

#include "apps/number_text.h"
#include "core/joined.h"

namespace stipple {

std::string recording_faults(const std::string& file, const RecordingFootage& footage) {
    auto faults = footage.recording().faults();
    if (footage.missing_frames() > 0)
        faults.push_back(
            fmt::format("lacks {}, missing or incomplete (the one before stands in for {})",
                        counted(footage.missing_frames(), "frame"), footage.held_slots()));
    if (faults.empty()) return {};
    return fmt::format("{}: {}; \"stipple capture replay\" lists the places", file, joined(faults));
}

}  // namespace stipple
