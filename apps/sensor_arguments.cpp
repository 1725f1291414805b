#include "apps/sensor_arguments.h"

#include "apps/number_check.h"
#include "apps/timing_arguments.h"

namespace stipple {

void add_sensor_arguments(Command& command, SensorChoice& sensor) {
    command.add_option("--sensor", sensor.sensor, "sensor, of \"stipple list sensors\" (paper)")
        .type_name("NAME|FILE")
        .input();
    command
        .add_option("--schedule", sensor.schedule,
                    "who exposes when, of \"stipple list schedules\" (random)")
        .type_name("NAME|FILE")
        .input();
    command.add_option("--seed", sensor.seed, "of noise and schedule (1)")
        .check(whole_check(0))
        .type_name("S");
    add_overrun(command, sensor.overrun);
}

std::vector<SettingsSection> sensor_sections(SensorChoice& sensor) {
    return {{"sensor", &sensor.settings}, {"schedule", &sensor.schedule_settings}};
}

}  // namespace stipple
