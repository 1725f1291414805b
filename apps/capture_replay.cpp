#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/capture_commands.h"
#include "apps/interrupt.h"
#include "apps/json_file.h"
#include "apps/leftovers.h"
#include "apps/number_check.h"
#include "apps/progress.h"
#include "capture/recording/recording_footage.h"
#include "core/frame_writer.h"

namespace stipple {
namespace {

struct ReplayOptions {
    std::string recording;
    std::string output;
    bool skip_gaps = false;
    bool keep_incomplete = false;
    double black_level_dn = 0;
};

void say_what_is_missing(const RecordingFootage& footage, std::int64_t slots,
                         const std::string& file, const RunOptions& run) {
    const RecordingReport& report = footage.recording().report();
    std::string text = fmt::format("{}: {} slots, {} frames missing or incomplete, {} slots held",
                                   file, slots, footage.missing_frames(), footage.held_slots());
    for (const RecordingDamage& damage : report.damage)
        text += fmt::format("\n! byte {}: {}, {} bytes skipped", damage.offset, damage.cause,
                            damage.bytes);
    if (report.unlisted_damage > 0)
        text += fmt::format("\n! {} further places of damage", report.unlisted_damage);
    if (!footage.recording().end()) text += "\n! the recording was cut off";
    run.say(text);
}

void replay(const ReplayOptions& options, const RunOptions& run) {
    RecordingFootage footage(options.recording, {.hold_missing = !options.skip_gaps,
                                                 .drop_incomplete = !options.keep_incomplete,
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
    const RecordingReport& report = footage.recording().report();
    json.write({{"slots", progress.done()},
                {"held_slots", footage.held_slots()},
                {"missing_frames", footage.missing_frames()},
                {"damaged_places", report.damage.size() + report.unlisted_damage},
                {"cut_off", !footage.recording().end()}});
    say_what_is_missing(footage, progress.done(), options.output, run);
}

}  // namespace

void add_capture_replay(Command& capture, Action& action) {
    Command command = capture.add_command("replay", "A recording as footage");
    const auto options = std::make_shared<ReplayOptions>();
    command.add_option("RECORDING", options->recording, "file of `capture record`")
        .required()
        .input();
    command.add_option("-o,--output", options->output, "footage: .npy, or a folder of EXR files")
        .type_name("OUT")
        .required()
        .output();
    command.add_flag("--skip-gaps", options->skip_gaps,
                     "leave missing frames out; else the frame before stands in");
    command.add_flag("--keep-incomplete", options->keep_incomplete,
                     "use incomplete frames, with black holes; else they count as missing");
    command.add_option("--black-level", options->black_level_dn, "DN without light (0)")
        .check(number_check(0))
        .type_name("DN");
    command.footer(
        "Examples:\n"
        "  stipple capture replay clip.strec -o light.npy --black-level 64\n"
        "  stipple emulate clip.strec -o clip.stipple        without a file in between");
    command.callback([options, &action] {
        action = [options](const RunOptions& run) { replay(*options, run); };
    });
}

}  // namespace stipple
