#include "apps/arguments/schedule.h"

#include "apps/arguments/common_options.h"
#include "core/geometry.h"
#include "readout/sensor_file.h"

namespace stipple {

SettingsSection schedule_section(ScheduleChoice& choice) {
    return {"schedule", &choice.settings};
}

void add_schedule_choice(Command& command, ScheduleChoice& choice) {
    command
        .add_option("SCHEDULE", choice.schedule,
                    "exposure schedule, of \"stipple list schedules\", or compiled (.mem, .hex)")
        .type_name("NAME|FILE")
        .listed("schedules")
        .required()
        .input();
    CommandOption size = add_size(command, "--size", choice.shape, {1, kMaxFrameSide},
                                  "width and height of the array");
    if (choice.shape.pixels() == 0) size.default_text("that of the sensor, or 640x480");
    add_seed(command, choice.seed, "seed of random codes");
}

NamedSchedule chosen_schedule(const ScheduleChoice& choice) {
    return set_up_schedule(
        {.schedule = choice.schedule, .schedule_settings = choice.settings, .seed = choice.seed},
        choice.shape, ColumnAddressing{});
}

}  // namespace stipple
