#pragma once

#include "apps/action.h"
#include "apps/command_line.h"

namespace stipple {

// Each function adds one subcommand of `stipple capture`. If the command line names it, parsing
// sets `action`.

void add_capture_list(Command& capture, Action& action);    ///< cameras that can be opened
void add_capture_doctor(Command& capture, Action& action);  ///< what would cost frames, its fix
void add_capture_live(Command& capture, Action& action);    ///< a camera to a sample stream
void add_capture_record(Command& capture, Action& action);  ///< a camera to a recording
void add_capture_replay(Command& capture, Action& action);  ///< a recording as footage
void add_capture_serve(Command& capture, Action& action);   ///< a source as a GigE camera

}  // namespace stipple
