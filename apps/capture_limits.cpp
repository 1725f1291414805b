#include "apps/capture_limits.h"

#include <CLI/CLI.hpp>

namespace stipple {

void add_capture_limits(CLI::App& command, CaptureLimits& limits) {
    command.add_option("--frames", limits.frames, "stop after so many (until Ctrl-C)")
        ->check(CLI::PositiveNumber)
        ->type_name("N");
    command.add_option("--seconds", limits.seconds, "stop after so long (until Ctrl-C)")
        ->check(CLI::PositiveNumber)
        ->type_name("S");
}

}  // namespace stipple
