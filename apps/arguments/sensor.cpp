#include "apps/arguments/sensor.h"

#include "apps/arguments/common_options.h"
#include "core/error.h"
#include "io/output_names.h"
#include "readout/sensor_file.h"

namespace stipple {

CommandOption add_sensor(Command& command, std::string& sensor) {
    return command.add_option("--sensor", sensor, "sensor, of \"stipple list sensors\"")
        .shows_default()
        .type_name("NAME|FILE")
        .listed("sensors")
        .input();
}

CommandOption add_schedule(Command& command, std::string& schedule) {
    return command
        .add_option("--schedule", schedule, "exposure schedule, of \"stipple list schedules\"")
        .shows_default()
        .type_name("NAME|FILE")
        .listed("schedules")
        .input();
}

void add_sensor_arguments(Command& command, SensorChoice& sensor) {
    add_sensor(command, sensor.sensor);
    add_schedule(command, sensor.schedule);
    add_seed(command, sensor.seed, "seed of noise and schedule");
    add_overrun(command, sensor.overrun);
}

void add_overrun(Command& command, OverrunPolicy& policy) {
    command
        .add_choice("--overrun", policy, kOverrunPolicies,
                    "a readout that exceeds its slot: stretch the slot, or drop its last rows; "
                    "drop needs a sensor with timing")
        .type_name("POLICY");
}

std::vector<SettingsSection> sensor_sections(SensorChoice& sensor) {
    return {{"sensor", &sensor.settings}, {"schedule", &sensor.schedule_settings}};
}

void add_waveform_arguments(Command& command, WaveformOptions& options) {
    constexpr int kMaxSlots = 1'000'000;
    const auto file =
        command
            .add_option("--vcd", options.file,
                        "write the readout as a waveform, .vcd or .fst, and a .gtkw for GTKWave; "
                        "needs a sensor with timing")
            .type_name("FILE")
            .output(kWaveformName);
    command.add_option("--vcd-slots", options.slots, "number of slots in the waveform")
        .shows_default()
        .check(whole_check(1, kMaxSlots))
        .type_name("N")
        .needs(file);
}

std::optional<WaveformFile> waveform_file(const WaveformOptions& options, bool force,
                                          bool has_timing) {
    if (options.file.empty()) return {};
    if (!has_timing) throw InputError("--vcd", "the sensor " + no_timing_text());
    return std::optional<WaveformFile>(std::in_place, options.file, force);
}

}  // namespace stipple
