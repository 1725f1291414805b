#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/arguments/schedule.h"
#include "apps/arguments/sensor.h"
#include "apps/report/json_file.h"
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

void check(const CheckOptions& options, const RunOptions& run) {
    const ScheduleChoice& choice = options.schedule;
    const SensorSetup setup = set_up_sensor({.sensor = options.sensor,
                                             .schedule = choice.schedule,
                                             .settings = options.sensor_settings,
                                             .schedule_settings = choice.settings,
                                             .seed = choice.seed},
                                            choice.shape);
    const std::string& name = setup.schedule.name;
    const SensorParams& sensor = setup.params;
    JsonFile json(run);
    const auto problem = schedule_problem(setup);
    std::optional<std::string> remark;
    if (setup.timing)
        remark = group_remark(setup.schedule.schedule, setup.timing->addressing, setup.shape);
    json.write({{"schedule", name},
                {"sensor", sensor.name},
                {"legal", !problem.has_value()},
                {"problem", problem.value_or("")},
                {"remark", remark.value_or("")}});
    if (problem)
        throw InputError(fmt::format("schedule {} on sensor {}", name, sensor.name), *problem);
    run.say(fmt::format("{} can be done by the sensor {}{}", name, sensor.name,
                        remark ? "; " + *remark : ""));
}

}  // namespace

void add_schedule_check(Command& schedule, Action& action) {
    Command command = schedule.add_command(
        "check", "Whether a sensor can do what a schedule says; exit code 1 if not");
    const auto options = std::make_shared<CheckOptions>();
    add_schedule_choice(command, options->schedule);
    add_settings(command,
                 {schedule_section(options->schedule), {"sensor", &options->sensor_settings}},
                 "change a key of the schedule or of the sensor");
    add_sensor(command, options->sensor);
    command.footer(
        "Examples:\n"
        "  stipple schedule check two_bucket --sensor paper --set sensor.charge_stores=2\n"
        "  stipple schedule check tiled --sensor lux1310 --size 1280x1024");
    set_action(command, action, options, check);
}

}  // namespace stipple
