#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "apps/arguments/command_line.h"
#include "apps/arguments/run_options.h"

namespace stipple {

/// The run that the command line asks for.
struct Action {
    std::function<void(const RunOptions&)> run;  ///< of the subcommand
    RunOptions options;
};

/// Sets `action` to `run` with `options` if the command line names `command`. `check` may throw
/// UsageError.
template <typename Options>
void set_action(
    Command& command, Action& action, const std::shared_ptr<Options>& options,
    void (*run)(const Options&, const RunOptions&), std::function<void()> check = [] {}) {
    command.callback([&action, options, run, check = std::move(check)] {
        check();
        action.run = [options, run](const RunOptions& told) { run(*options, told); };
    });
}

// Each function adds one subcommand to `app`. If the command line names it, parsing sets `action`.

void add_synth(Command& app, Action& action);     ///< a scene rendered to footage
void add_emulate(Command& app, Action& action);   ///< footage to sample stream
void add_chip(Command& app, Action& action);      ///< a chip that is driven through registers
void add_import(Command& app, Action& action);    ///< measurements and masks to sample stream
void add_export(Command& app, Action& action);    ///< sample stream to measurements and masks
void add_decode(Command& app, Action& action);    ///< sample stream to video
void add_join(Command& app, Action& action);      ///< windows of parts to video
void add_compare(Command& app, Action& action);   ///< quality of a video against its reference
void add_info(Command& app, Action& action);      ///< contents of a file of any kind
void add_recover(Command& app, Action& action);   ///< partial outputs of killed runs
void add_schedule(Command& app, Action& action);  ///< exposure schedules: its own subcommands
void add_timing(Command& app, Action& action);    ///< how fast a sensor reads
void add_rtl(Command& app, Action& action);       ///< the chip in gates for a sensor
/// EMVA 1288 figures of an emulated sensor or of images
void add_characterize(Command& app, Action& action);
void add_calibrate(Command& app, Action& action);   ///< gain, offset and defects of each pixel
void add_dictionary(Command& app, Action& action);  ///< patches of footage, for hitomi2011
void add_capture(Command& app, Action& action);     ///< cameras: its own subcommands
void add_demo(Command& app, Action& action);        ///< all of it on an embedded scene
void add_explore(Command& app, Action& action);     ///< a table of many trials
/// Coded exposure and its rivals on a scene
void add_rivals(Command& app, Action& action);
void add_report(Command& app, Action& action);  ///< a run as an HTML page
void add_view(Command& app, Action& action);    ///< streams and videos in the browser
void add_list(Command& app, Action& action);    ///< names that options take, a line each
/// Manual pages and completions of the command line that `describe` describes
void add_manual(Command& app, Action& action, std::function<CommandDescription()> describe);

// Those of `stipple capture`.

void add_capture_list(Command& capture, Action& action);  ///< cameras that can be opened
/// values and ranges of a camera's features
void add_capture_features(Command& capture, Action& action);
void add_capture_doctor(Command& capture, Action& action);  ///< faults that cost frames, with fixes
void add_capture_live(Command& capture, Action& action);    ///< a camera to a sample stream
void add_capture_record(Command& capture, Action& action);  ///< a camera to a recording
void add_capture_replay(Command& capture, Action& action);  ///< a recording as footage
void add_capture_serve(Command& capture, Action& action);   ///< a source as a GigE camera

// Those of `stipple schedule`.

void add_schedule_make(Command& schedule, Action& action);     ///< any schedule, as explicit codes
void add_schedule_show(Command& schedule, Action& action);     ///< timing diagram and figures
void add_schedule_check(Command& schedule, Action& action);    ///< can a sensor do it
void add_schedule_compile(Command& schedule, Action& action);  ///< the chip's sequencer program
void add_schedule_import(Command& schedule, Action& action);   ///< from a volume in a .npy

}  // namespace stipple
