#include "apps/fault_arguments.h"

#include <string>

#include "apps/number_check.h"
#include "capture/serve/gige_server.h"

namespace stipple {

void add_fault_arguments(Command& command, GigeServerOptions& options) {
    constexpr auto kGroup = "Faults, for tests of clients";
    GvspFaults& faults = options.faults;
    const auto share = [&](const std::string& name, double& value, const std::string& what) {
        command.add_option(name, value, what)
            .check(number_check(0, 1))
            .type_name("SHARE")
            .group(kGroup);
    };
    const auto count = [&](const std::string& name, auto& value, const std::string& what) {
        return command.add_option(name, value, what).type_name("N").group(kGroup);
    };
    share("--fault-drop", faults.drop, "packets that are only sent when they are asked for again");
    share("--fault-lose", faults.lose, "packets that are never sent");
    share("--fault-duplicate", faults.duplicate, "packets that are sent twice");
    command.add_flag("--fault-reorder", faults.reorder, "packets change places").group(kGroup);
    auto gap_at = count("--fault-gap-at", faults.gap_at, "frame before which ids are left out");
    auto gap = count("--fault-gap", faults.gap_frames, "how many ids are left out there");
    gap_at.needs(gap);
    gap.needs(gap_at);
    count("--fault-first-block", faults.first_block, "block id of the first frame (1)")
        .check(whole_check(1, 65535));
    count("--fault-freeze-at", faults.freeze_at, "frame from which on nothing is sent");
    count("--fault-seed", faults.seed, "which packets are hit (1)");
    command
        .add_flag(
            "--no-resend", [&options] { options.can_resend = false; },
            "a camera that cannot send packets again")
        .group(kGroup);
}

}  // namespace stipple
