#pragma once

#include "apps/action.h"
#include "apps/command_line.h"

namespace stipple {

// Each function adds one subcommand of `stipple schedule`. If the command line names it, parsing
// sets `action`.

void add_schedule_make(Command& schedule, Action& action);     ///< any schedule, written out
void add_schedule_show(Command& schedule, Action& action);     ///< timing diagram and figures
void add_schedule_check(Command& schedule, Action& action);    ///< can a sensor do it
void add_schedule_compile(Command& schedule, Action& action);  ///< the chip's sequencer program
void add_schedule_import(Command& schedule, Action& action);   ///< from a volume in a .npy

}  // namespace stipple
