#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/recording/recording_footage.h"
#include "core/error.h"
#include "core/message.h"
#include "io/frame_writer.h"
#include "io/output_names.h"

namespace stipple {
namespace {

struct ReplayOptions {
    std::string recording;
    std::string output;
    bool skip_gaps = false;
    bool fill_gaps = false;
    bool keep_incomplete = false;
    double black_level_dn = 0;
};

nlohmann::ordered_json figures_of(const RecordingFootage& footage, std::int64_t slots) {
    const RecordingReport& report = footage.recording().report();
    auto gaps = nlohmann::ordered_json::array();
    for (const auto& [slot, frames] : footage.gaps())
        gaps.push_back({{"slot", slot}, {"frames", frames}});
    return {{"slots", slots},
            {"held_slots", footage.held_slots()},
            {"missing_frames", footage.missing_frames()},
            {"gaps", gaps},
            {"damaged_places", report.damage.size() + report.unlisted_damage},
            {"cut_off", !footage.recording().end()}};
}

/// The gaps in the sequence of frames; empty if there are none.
std::string gaps_text(const RecordingFootage& footage) {
    std::string text;
    const auto& gaps = footage.gaps();
    for (std::size_t i = 0; i < std::min(gaps.size(), kMaxShownFaults); ++i)
        text += fmt::format("{}{} at slot {}", i == 0 ? "" : ", ", gaps[i].frames, gaps[i].slot);
    if (gaps.size() > kMaxShownFaults) text += ", and more (--json lists them)";
    return text;
}

/// Warns of missing frames and of a missing end. \throws InputError listing the damage, if there is
/// any.
void say_what_is_wrong(const std::string& file, const RecordingFootage& footage) {
    const RecordingReport& report = footage.recording().report();
    if (footage.missing_frames() > 0)
        say_warning("{}: {} missing or incomplete: {}", file,
                    counted(footage.missing_frames(), "frame"), gaps_text(footage));
    if (!footage.recording().end()) say_warning("{}: was cut off before its end", file);
    const std::size_t places = report.damage.size() + report.unlisted_damage;
    if (places == 0) return;
    std::string text = "the recording is damaged";
    for (std::size_t i = 0; i < std::min(report.damage.size(), kMaxShownFaults); ++i)
        text += fmt::format("\n  byte {}: {}, {} skipped", report.damage[i].offset,
                            report.damage[i].cause, counted(report.damage[i].bytes, "byte"));
    if (places > kMaxShownFaults) text += fmt::format("\n  and {} more", places - kMaxShownFaults);
    throw InputError(file, text + "\n  the output contains the undamaged part");
}

void replay(const ReplayOptions& options, const RunOptions& run) {
    RecordingFootage footage(options.recording, {.hold_missing = !options.skip_gaps,
                                                 .drop_incomplete = !options.keep_incomplete,
                                                 .fill_gaps = options.fill_gaps,
                                                 .black_level_dn = options.black_level_dn});
    JsonFile json(run);
    FrameWriter writer(options.output, footage.shape(), {.force = run.force});
    say_leftover(options.output);
    Progress progress(run, "replaying", std::nullopt);
    for (std::vector<float> frame(footage.shape().sites());
         stop_signal() == 0 && footage.read(frame); progress.advance())
        writer.write(frame);
    if (progress.done() == 0) throw_if_stopped();
    writer.finish();
    json.write(figures_of(footage, progress.done()));
    run.say(fmt::format("{}: {}, {} held for frames that are missing", options.output,
                        counted(progress.done(), "slot"), footage.held_slots()));
    if (stop_signal() == 0) say_what_is_wrong(options.recording, footage);
}

}  // namespace

void add_capture_replay(Command& capture, Action& action) {
    Command command = capture.add_command("replay", "A recording as footage");
    const auto options = std::make_shared<ReplayOptions>();
    command.add_option("RECORDING", options->recording, "file of \"capture record\"")
        .required()
        .input();
    add_output(command, options->output, "footage: .npy, or a folder of EXR files", kVideoName,
               "OUT");
    command.add_flag("--skip-gaps", options->skip_gaps,
                     "leave missing frames out instead of holding the previous frame");
    command.add_flag("--fill-gaps", options->fill_gaps,
                     "hold the previous frame even if most frames are missing");
    command.add_flag("--keep-incomplete", options->keep_incomplete,
                     "use incomplete frames, with black holes, instead of counting them missing");
    command.add_option("--black-level", options->black_level_dn, "DN without light")
        .shows_default()
        .check(number_check(0))
        .type_name("DN");
    command.footer(
        "Examples:\n"
        "  stipple capture replay clip.strec -o light.npy --black-level 64\n"
        "  stipple emulate clip.strec -o clip.stipple        without a file in between");
    set_action(command, action, options, replay);
}

}  // namespace stipple
