#include "apps/timing_arguments.h"

#include <CLI/CLI.hpp>
#include <map>

#include "core/error.h"

namespace stipple {

void add_waveform_arguments(CLI::App& command, WaveformOptions& options) {
    constexpr int kMostSlots = 1'000'000;
    auto* file =
        command.add_option("--vcd", options.file, "write the readout as a waveform, for GTKWave")
            ->type_name("FILE");
    command.add_option("--vcd-slots", options.slots, "slots in it at most (16)")
        ->check(CLI::Range(1, kMostSlots))
        ->type_name("N")
        ->needs(file);
}

std::optional<WaveformFile> waveform_file(const WaveformOptions& options, bool force,
                                          bool has_timing) {
    if (options.file.empty()) return {};
    if (!has_timing)
        throw InputError("--vcd",
                         "the sensor has no section [timing]; `stipple timing` lists "
                         "those that have one");
    return std::optional<WaveformFile>(std::in_place, options.file, force);
}

void add_overrun(CLI::App& command, OverrunPolicy& policy) {
    const std::map<std::string, OverrunPolicy> policies{{"stretch", OverrunPolicy::kStretch},
                                                        {"drop", OverrunPolicy::kDrop}};
    command
        .add_option_function<std::string>(
            "--overrun",
            [&policy, policies](const std::string& name) { policy = policies.at(name); },
            "what a readout that exceeds its slot does: stretch it, or drop rows (stretch)")
        ->check(CLI::IsMember({"stretch", "drop"}))
        ->type_name("POLICY");
}

}  // namespace stipple
