#include "apps/arguments/schedule.h"

#include "apps/arguments/checks.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

constexpr int kMaxSide = 65535;

}  // namespace

SettingsSection schedule_section(ScheduleChoice& choice) {
    return {"schedule", &choice.settings};
}

void add_schedule_choice(Command& command, ScheduleChoice& choice) {
    command
        .add_option("SCHEDULE", choice.schedule,
                    "name of config/schedules, file of that form, or compiled .mem or .hex")
        .type_name("NAME|FILE")
        .listed("schedules")
        .required()
        .input();
    command
        .add_parsed(
            "--size",
            [&choice](const std::string& text) {
                parse_size("--size", text, 1, kMaxSide, choice.shape);
            },
            "width and height of the array (640x480)")
        .type_name("WxH");
    command.add_option("--seed", choice.seed, "of random codes (1)")
        .check(whole_check(0))
        .type_name("S");
}

NamedSchedule set_up_schedule(const ScheduleChoice& choice) {
    return set_up_schedule(
        {.schedule = choice.schedule, .schedule_settings = choice.settings, .seed = choice.seed},
        choice.shape, ColumnAddressing{});
}

}  // namespace stipple
