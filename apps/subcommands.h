#pragma once

#include "apps/action.h"
#include "apps/command_line.h"

namespace stipple {

// Each function adds one subcommand to `app`. If the command line names it, parsing sets `action`.

void add_synth(Command& app, Action& action);     ///< a scene rendered to footage
void add_emulate(Command& app, Action& action);   ///< footage to sample stream
void add_decode(Command& app, Action& action);    ///< sample stream to video
void add_compare(Command& app, Action& action);   ///< quality of a video against its reference
void add_info(Command& app, Action& action);      ///< what a sample stream says and holds
void add_recover(Command& app, Action& action);   ///< what killed runs have left
void add_schedule(Command& app, Action& action);  ///< exposure schedules: its own subcommands
void add_timing(Command& app, Action& action);    ///< how fast a sensor reads
/// EMVA 1288 figures of an emulated sensor or of images
void add_characterize(Command& app, Action& action);
void add_capture(Command& app, Action& action);  ///< cameras: its own subcommands
void add_demo(Command& app, Action& action);     ///< all of it on an embedded scene
void add_list(Command& app, Action& action);     ///< names that options take, a line each

}  // namespace stipple
