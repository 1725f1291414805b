#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "apps/interrupt.h"
#include "apps/json_file.h"
#include "apps/provenance.h"
#include "apps/stream_text.h"
#include "apps/subcommands.h"
#include "core/error.h"

namespace stipple {
namespace {

void info(const std::string& file, const RunOptions& run) {
    StreamReader reader(file);
    JsonFile json(run);
    SamplePacket packet;
    while (reader.next(packet)) throw_if_stopped();
    auto figures = stream_json(reader.header(), reader.report());
    const std::string command = command_of(reader.header().provenance);
    figures["command"] = nullptr;
    if (!command.empty()) figures["command"] = command;
    json.write(figures);
    run.say(stream_text(reader.header(), reader.report()));
    const std::string& provenance = reader.header().provenance;
    if (!provenance.empty()) run.say(fmt::format("provenance\n{}", provenance));
    if (!command.empty()) run.say(fmt::format("again        {}", command));
    if (!undamaged(reader.report())) throw InputError(file, damage_text(reader.report()));
    run.say(reader.report().complete
                ? "condition    undamaged, complete"
                : "condition    undamaged, without an end marker: cut off, or still being written");
}

}  // namespace

void add_info(Command& app, Action& action) {
    Command command = app.add_command("info", "Say what a sample stream is and holds");
    const auto file = std::make_shared<std::string>();
    command.add_option("STREAM", *file, "sample stream").required().input();
    command.footer(
        "Examples:\n"
        "  stipple info clip.stipple\n"
        "  stipple info clip.stipple --json -\n"
        "The whole stream is checked. If it is damaged, the damage is listed, the exit code is 1.");
    command.callback(
        [file, &action] { action = [file](const RunOptions& run) { info(*file, run); }; });
}

}  // namespace stipple
