#include "apps/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "capture/frame_sequence.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "core/message.h"
#include "core/text.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// Missing frames between two recorded ones.
struct Gap {
    std::uint64_t before_frame;  ///< id of the frame after it
    std::uint64_t frames;
    GapCause cause;
};

/// Statistics of the frames.
struct FrameSummary {
    std::optional<FrameRecord> first;
    std::uint64_t incomplete = 0;
    std::uint64_t missing = 0;
    std::uint64_t gaps = 0;
    std::vector<Gap> listed;  ///< the first of them
    FrameRate rate;
    GapFiller filler;

    void add(const FrameRecord& record) {
        const std::uint64_t lost = filler.next(record).lost;
        if (!first) first = record;
        rate.add(record);
        if (record.status != FrameStatus::kComplete) ++incomplete;
        if (lost == 0) return;
        missing += lost;
        ++gaps;
        if (listed.size() < kMaxListedFaults) listed.push_back({record.id, lost, record.cause});
    }
};

/// Frames that were lost after the last one in an undamaged file: the end record counts all.
std::uint64_t missing_after_last(const RecordingReader& reader, const FrameSummary& frames) {
    if (!reader.end()) return 0;
    const auto& lost = reader.end()->lost;
    const auto all = std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
    return all - std::min(all, frames.missing);
}

/// Text of an untrusted file, for a terminal.
std::string plain(const std::string& text) {
    return is_plain_text(text, false) ? text : "(not printable)";
}

std::string_view cause_of(const Gap& gap) {
    // Damage of the file leaves no record of a cause.
    return gap.cause == GapCause::kNone ? "damage" : name_in(kGapCauses, gap.cause);
}

ordered_json info_json(const RecordingReader& reader, const FrameSummary& frames) {
    const CameraDescription& camera = reader.session().camera;
    const RecordingReport& report = reader.report();
    std::map<std::string, std::string> settings;  // the last one of a name holds
    for (const auto& [name, value] : reader.session().settings) settings[name] = value;
    ordered_json json{{"kind", "recording"},
                      {"camera",
                       {{"transport", camera.transport},
                        {"vendor", camera.vendor},
                        {"model", camera.model},
                        {"serial", camera.serial}}},
                      {"settings", settings},
                      {"frames", report.frames},
                      {"incomplete", frames.incomplete},
                      {"missing_frames", frames.missing},
                      {"missing_after_last", missing_after_last(reader, frames)},
                      {"gaps", ordered_json::array()},
                      {"width", nullptr},
                      {"height", nullptr},
                      {"format", nullptr},
                      {"frames_hz", nullptr},
                      {"end_reason", nullptr},
                      {"complete", reader.end().has_value()},
                      {"tail_bytes", report.tail_bytes},
                      {"damaged_places", report.damage.size() + report.unlisted_damage}};
    for (const Gap& gap : frames.listed)
        json["gaps"].push_back(
            {{"before_frame", gap.before_frame}, {"frames", gap.frames}, {"cause", cause_of(gap)}});
    if (frames.first) {
        json["width"] = frames.first->layout.width;
        json["height"] = frames.first->layout.height;
        json["format"] = frames.first->layout.format->name;
    }
    if (frames.rate.hz()) json["frames_hz"] = *frames.rate.hz();
    if (reader.end()) json["end_reason"] = reader.end()->reason;
    return json;
}

std::string gaps_text(const FrameSummary& frames, std::uint64_t after_last) {
    if (frames.gaps + after_last == 0) return "missing      none";
    std::string text =
        fmt::format("missing      {} frames in {} places", frames.missing, frames.gaps);
    if (after_last > 0) text += fmt::format(", and {} after the last frame", after_last);
    for (std::size_t i = 0; i < std::min(frames.listed.size(), kMaxShownFaults); ++i)
        text += fmt::format("\n             {} before frame {}: {}", frames.listed[i].frames,
                            frames.listed[i].before_frame, cause_of(frames.listed[i]));
    if (frames.gaps > kMaxShownFaults)
        text += fmt::format("\n             and {} more", frames.gaps - kMaxShownFaults);
    return text;
}

std::string info_text(const RecordingReader& reader, const FrameSummary& frames) {
    const CameraDescription& camera = reader.session().camera;
    std::string text = fmt::format("camera       {}", plain(camera.transport));
    for (const std::string& fact : {camera.vendor, camera.model, camera.serial})
        if (!fact.empty()) text += fmt::format(", {}", plain(fact));
    if (frames.first) {
        const FrameLayout& layout = frames.first->layout;
        text += fmt::format("\nframes       {} x {} (width x height) {}, {} of them", layout.width,
                            layout.height, layout.format->name, reader.report().frames);
        if (frames.incomplete > 0) text += fmt::format(", {} incomplete", frames.incomplete);
        if (frames.rate.hz())
            text += fmt::format("\nrate         {:.5g} per second", *frames.rate.hz());
    } else {
        text += "\nframes       none";
    }
    text.append(1, '\n').append(gaps_text(frames, missing_after_last(reader, frames)));
    for (const auto& [name, value] : reader.session().settings)
        text += fmt::format("\nsetting      {} = {}", plain(name), plain(value));
    return text;
}

std::string condition_text(const RecordingReader& reader) {
    if (reader.end()) return fmt::format("undamaged, complete ({})", plain(reader.end()->reason));
    const RecordingReport& report = reader.report();
    std::string text =
        fmt::format("cut off, or still being written; {} frames are whole", report.frames);
    if (report.tail_bytes > 0)
        text += fmt::format(", {} bytes of the next one follow", report.tail_bytes);
    return text;
}

}  // namespace

void info_recording(const std::string& file, const RunOptions& run) {
    RecordingReader reader(file);
    JsonFile json(run);
    FrameSummary frames;
    CapturedFrame frame;
    while (reader.next(frame)) {
        throw_if_stopped();
        frames.add(frame.record);
    }
    json.write(info_json(reader, frames));
    run.say(info_text(reader, frames));
    if (!reader.report().damage.empty()) throw InputError(file, joined(reader.faults()));
    run.say(fmt::format("condition    {}{}", condition_text(reader), leftover_text(file)));
}

}  // namespace stipple
