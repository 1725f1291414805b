#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/arguments/schedule.h"
#include "apps/arguments/sensor.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "readout/schedule_feasibility.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

struct CheckOptions {
    ScheduleChoice schedule;
    std::string sensor = "paper";
    std::vector<std::string> sensor_settings = {};
};

/// The array that is asked for, else that of the sensor, else that of the other commands.
FrameShape array_of(const ScheduleChoice& choice, const SensorDescription& sensor) {
    if (choice.shape.pixels() != 0) return choice.shape;
    if (!sensor.timing) return ScheduleChoice{}.shape;
    return {.rows = sensor.timing->rows, .cols = sensor.timing->cols, .planes = 1};
}

void check(const CheckOptions& options, const RunOptions& run) {
    const SensorChoice choice{.sensor = options.sensor,
                              .schedule = options.schedule.schedule,
                              .settings = options.sensor_settings,
                              .schedule_settings = options.schedule.settings,
                              .seed = options.schedule.seed};
    const SensorDescription sensor = read_sensor_file(choice);
    FrameShape shape = array_of(options.schedule, sensor);
    if (sensor.params.physical.cfa != ColourFilter::kNone) shape.planes = 3;
    const SensorSetup setup = set_up_sensor(sensor, choice, shape);
    const std::string& name = setup.schedule.name;
    const std::string size = fmt::format("{} x {}", shape.cols, shape.rows);
    JsonFile json(run);
    const auto problem = schedule_problem(setup);
    std::optional<std::string> remark;
    if (setup.timing)
        remark = group_remark(setup.schedule.schedule, setup.timing->addressing, setup.shape);
    json.write({{"schedule", name},
                {"sensor", sensor.params.name},
                {"width", shape.cols},
                {"height", shape.rows},
                {"legal", !problem.has_value()},
                {"problem", problem.value_or("")},
                {"remark", remark.value_or("")}});
    if (problem)
        throw InputError(
            fmt::format("schedule {} on sensor {}, {}", name, sensor.params.name, size), *problem);
    run.say(fmt::format("the sensor {} can run {} at {}{}", sensor.params.name, name, size,
                        remark ? "; " + *remark : ""));
}

}  // namespace

void add_schedule_check(Command& schedule, Action& action) {
    Command command = schedule.add_command(
        "check", "Whether a sensor can do what a schedule says; exit code 1 if not");
    const auto options = std::make_shared<CheckOptions>();
    options->schedule.shape = {.rows = 0, .cols = 0, .planes = 1};
    add_schedule_choice(command, options->schedule);
    add_settings(command,
                 {schedule_section(options->schedule), {"sensor", &options->sensor_settings}},
                 "change a key of the schedule or of the sensor");
    add_sensor(command, options->sensor);
    command.footer(
        "Examples:\n"
        "  stipple schedule check two_bucket --sensor paper --set sensor.charge_stores=2\n"
        "  stipple schedule check tiled --sensor lux1310 --size 640x480");
    set_action(command, action, options, check);
}

}  // namespace stipple
