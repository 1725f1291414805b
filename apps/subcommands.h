#pragma once

#include "apps/run_options.h"

namespace stipple {

// Each function adds one subcommand to `app`. If the command line names it, parsing sets `action`.

void add_synth(CLI::App& app, Action& action);     ///< a scene rendered to footage
void add_emulate(CLI::App& app, Action& action);   ///< footage to sample stream
void add_decode(CLI::App& app, Action& action);    ///< sample stream to video
void add_compare(CLI::App& app, Action& action);   ///< quality of a video against its reference
void add_info(CLI::App& app, Action& action);      ///< what a sample stream says and holds
void add_schedule(CLI::App& app, Action& action);  ///< exposure schedules: its own subcommands
void add_timing(CLI::App& app, Action& action);    ///< how fast a sensor reads
/// EMVA 1288 figures of an emulated sensor or of images
void add_characterize(CLI::App& app, Action& action);
void add_capture(CLI::App& app, Action& action);  ///< cameras: its own subcommands
void add_demo(CLI::App& app, Action& action);     ///< all of it on an embedded scene

}  // namespace stipple
