#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "apps/info_recording.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/stream_text.h"
#include "apps/subcommands.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "readout/provenance.h"
#include "readout/timing/stretched_slots.h"
#include "stream/stream_figures.h"

namespace stipple {
namespace {

std::string condition_of(const StreamReport& report) {
    if (report.complete) return "undamaged, complete";
    return fmt::format(
        "undamaged, without an end marker: cut off, or still being written; {} slots are whole",
        report.slots);
}

std::string stretched_text(const StretchedSlots& stretched, const StreamReader& reader) {
    return fmt::format(
        "overruns     a slot is nominally {} us; {} of {} slots were stretched{}",
        reader.header().slot_us, stretched.slots(), reader.report().slots,
        stretched.mean_us() ? fmt::format(", mean {:.4g} us", *stretched.mean_us()) : "");
}

void info(const std::string& file, const RunOptions& run) {
    if (is_recording(file)) return info_recording(file, run);
    StreamReader reader(file, ReadPolicy::kCounts);
    JsonFile json(run);
    SamplePacket packet;
    StretchedSlots stretched(reader.header(), max_memory(input_bytes(file)));
    while (reader.next(packet)) {
        throw_if_stopped();
        stretched.add(packet);
    }
    auto figures = stream_json(reader.header(), reader.report());
    const std::string command = command_of(reader.header().provenance);
    figures["stretched_slots"] = stretched.slots();
    figures["mean_stretched_us"] = nullptr;
    if (stretched.mean_us()) figures["mean_stretched_us"] = *stretched.mean_us();
    figures["command"] = nullptr;
    if (!command.empty()) figures["command"] = command;
    json.write(figures);
    run.say(stream_text(reader.header(), reader.report()));
    if (stretched.slots() > 0) run.say(stretched_text(stretched, reader));
    const std::string& provenance = reader.header().provenance;
    if (!provenance.empty()) run.say(fmt::format("provenance\n{}", provenance));
    if (!command.empty()) run.say(fmt::format("again        {}", command));
    if (!undamaged(reader.report()))
        throw InputError(file, damage_text(reader.report()) + leftover_text(file));
    run.say(fmt::format("condition    {}{}", condition_of(reader.report()), leftover_text(file)));
}

}  // namespace

void add_info(Command& app, Action& action) {
    Command command =
        app.add_command("info", "Say what a sample stream or a recording is and holds");
    const auto file = std::make_shared<std::string>();
    command.add_option("FILE", *file, "sample stream, or recording of a camera").required().input();
    command.footer(
        "Examples:\n"
        "  stipple info clip.stipple\n"
        "  stipple info clip.stipple --json -\n"
        "  stipple info clip.strec\n"
        "The whole file is checked. If it is damaged, the damage is listed, the exit code is 1.");
    set_action(command, action, file, info);
}

}  // namespace stipple
