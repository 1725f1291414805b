#include "capture/recording/footage_notes.h"

#include <fmt/format.h>

#include <utility>

#include "capture/sensor_warnings.h"
#include "core/text.h"

namespace stipple {
namespace {

void add(std::vector<Message>& notes, Message note) {
    if (!note.empty()) notes.push_back(std::move(note));
}

}  // namespace

std::vector<Message> sensor_notes(const std::string& name, const ReadAhead& footage,
                                  const SensorParams& sensor, bool resampled) {
    std::vector<Message> notes;
    const auto hz = footage.frames_hz();
    if (hz && !resampled) add(notes, video_rate_warning(name, *hz, sensor));
    if (const auto exposure_us = footage.exposure_us())
        add(notes, exposure_warning(name, *exposure_us, sensor));
    add(notes, black_level_warning(name, footage.traits(), sensor));
    return notes;
}

std::string recording_note(const std::string& name, const ReadAhead& footage) {
    if (!footage.ended() || footage.recording() == nullptr) return {};
    const RecordingFootage& recording = *footage.recording();
    auto faults = recording.recording().faults();
    const std::uint64_t missing = recording.missing_frames();
    if (missing > 0)
        faults.push_back(
            fmt::format("has {} missing or incomplete frame{} ({} replaced by the previous frame)",
                        missing, missing == 1 ? "" : "s", recording.held_slots()));
    if (faults.empty()) return {};
    return fmt::format("{}: {}; \"stipple capture replay\" lists the places", name, joined(faults));
}

std::vector<Message> end_notes(const std::string& name, const ReadAhead& footage,
                               const SensorParams& sensor, bool resampled) {
    std::vector<Message> notes;
    add(notes, recording_note(name, footage));
    if (!resampled && footage.ended() && footage.recording() != nullptr)
        add(notes, recording_rate_warning(name, footage.recording()->rate(), sensor));
    return notes;
}

}  // namespace stipple
