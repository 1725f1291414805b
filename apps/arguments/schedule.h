#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "apps/arguments/settings.h"
#include "core/geometry.h"
#include "readout/schedules/named_schedule.h"

namespace stipple {

/// The arguments of `stipple schedule ...` that name a schedule and the array it is made for.
struct ScheduleChoice {
    std::string schedule;                    ///< name, file, or compiled file (.mem, .hex)
    std::vector<std::string> settings = {};  ///< "key=value" of the schedule
    FrameShape shape = {.rows = 480, .cols = 640, .planes = 1};  ///< of the array
    std::uint64_t seed = 1;
};

/// NAME|FILE, --size and --seed.
void add_schedule_choice(Command& command, ScheduleChoice& choice);

/// The section of `--set schedule.KEY=VALUE`.
[[nodiscard]] SettingsSection schedule_section(ScheduleChoice& choice);

/// Reads the schedule and makes it for the array. \throws InputError naming file, line and key.
[[nodiscard]] NamedSchedule chosen_schedule(const ScheduleChoice& choice);

}  // namespace stipple
