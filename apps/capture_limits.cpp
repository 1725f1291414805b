#include "apps/capture_limits.h"

#include "apps/number_check.h"

namespace stipple {

void add_capture_limits(Command& command, CaptureLimits& limits) {
    command.add_option("--frames", limits.frames, "stop after so many (until Ctrl-C)")
        .check(whole_check(1, std::uint64_t{1} << 53U))
        .type_name("N");
    command.add_option("--seconds", limits.seconds, "stop after so long (until Ctrl-C)")
        .check(positive_check())
        .type_name("S");
}

}  // namespace stipple
