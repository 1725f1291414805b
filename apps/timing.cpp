#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/arguments/sensor.h"
#include "apps/interrupt.h"
#include "apps/output/emulation_text.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/geometry.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

struct TimingOptions {
    SensorChoice sensor;
    FrameShape roi{.rows = 0, .cols = 0, .planes = 1};  ///< 0: the whole array
    WaveformOptions waveform;
};

SensorDescription read_timed_sensor(const SensorChoice& choice) {
    SensorDescription sensor = read_sensor_file(choice);
    if (!sensor.timing)
        throw InputError(fmt::format("sensor \"{}\"", choice.sensor), no_timing_text());
    return sensor;
}

void time_readout(const TimingOptions& options, const RunOptions& run) {
    const SensorDescription sensor = read_timed_sensor(options.sensor);
    const ReadoutTiming& timing = *sensor.timing;
    FrameShape shape = options.roi;
    if (shape.rows == 0) shape = {.rows = timing.rows, .cols = timing.cols, .planes = 1};
    check_window(timing, shape);
    JsonFile json(run);
    auto waveform = waveform_file(options.waveform, run.force, true);
    const NamedSchedule named = set_up_schedule(options.sensor, shape, timing.addressing);
    const SlotBudget budget{slot_clocks(timing, sensor.params.slot_us), OverrunPolicy::kStretch};
    ReadoutCost cost(timing, named.schedule, shape, budget);
    const ReadoutRate rate = rate_of(timing, named.schedule, shape, budget.clocks);
    if (waveform)
        waveform->write(cost, sensor.params.name,
                        {cost.first_steady_slot(),
                         std::min(options.waveform.slots, named.schedule.period_slots())},
                        [] { return stop_signal() == 0; });
    nlohmann::ordered_json figures{{"sensor", sensor.params.name}, {"schedule", named.name}};
    figures.update(rate_json(rate, cost));
    json.write(figures);
    run.say(fmt::format("sensor       {}, schedule {}\n{}", sensor.params.name, named.name,
                        rate_text(rate, cost)));
}

}  // namespace

void add_timing(Command& app, Action& action) {
    Command command = app.add_command("timing", "How fast a sensor reads, in full and coded");
    const auto options = std::make_shared<TimingOptions>();
    command.add_option("--sensor", options->sensor.sensor, "sensor with a section [timing]")
        .type_name("NAME|FILE")
        .listed("sensors")
        .required()
        .input();
    add_schedule(command, options->sensor.schedule);
    add_size(command, "--roi,--size", options->roi, {1, kMaxFrameSide},
             "window: the first W columns and H rows")
        .default_text("the whole array");
    add_settings(command, sensor_sections(options->sensor),
                 "change a key of the sensor or of the schedule");
    add_seed(command, options->sensor.seed, "seed of the schedule");
    add_waveform_arguments(command, options->waveform);
    command.footer(
        "Examples:\n"
        "  stipple timing --sensor lux1310\n"
        "  stipple timing --sensor vita --roi 640x480 --schedule tiled --json -\n"
        "  stipple timing --sensor lux1310 --set sensor.timing.addressing=group --vcd readout.vcd");
    set_action(command, action, options, time_readout);
}

}  // namespace stipple
