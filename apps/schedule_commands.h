#pragma once

#include "apps/run_options.h"

namespace stipple {

// Each function adds one subcommand of `stipple schedule`. If the command line names it, parsing
// sets `action`.

void add_schedule_make(CLI::App& schedule, Action& action);     ///< any schedule, written out
void add_schedule_show(CLI::App& schedule, Action& action);     ///< timing diagram and figures
void add_schedule_check(CLI::App& schedule, Action& action);    ///< can a sensor do it
void add_schedule_compile(CLI::App& schedule, Action& action);  ///< the chip's sequencer program
void add_schedule_import(CLI::App& schedule, Action& action);   ///< from a volume in a .npy

}  // namespace stipple
