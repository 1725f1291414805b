#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/arguments/footage.h"
#include "apps/info.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "calibration/calibration_file.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "readout/provenance.h"
#include "readout/timing/stretched_slots.h"
#include "session/rig_folder.h"
#include "session/stream_calibration.h"
#include "stream/stream_figures.h"
#include "study/report/json_figures.h"
#include "study/report/stream_text.h"

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

/// Of a calibration file beside a stream.
std::string calibration_line(const std::string& file, const StreamHeader& header) {
    try {
        const ChipCalibration calibration = read_calibration(file, header);
        return fmt::format("calibrated   by {}, from {} and {} of each pixel", file,
                           counted(calibration.flats, "flat"), counted(calibration.darks, "dark"));
    } catch (const InputError& error) {
        return fmt::format("calibrated   not: {}", error.message().text(in_options));
    }
}

struct InfoOptions {
    std::string file;
    std::optional<RawFormat> raw;
    bool header_only = false;
};

void info_stream(const std::string& file, const RunOptions& run) {
    StreamReader reader(file, ReadPolicy::kCounts);
    reader.follow_switches();
    JsonFile json(run);
    SamplePacket packet;
    StretchedSlots stretched(reader.header(), max_memory(input_bytes(file)));
    while (reader.next(packet)) {
        throw_if_stopped();
        stretched.add(packet);
    }
    nlohmann::ordered_json figures;
    figures["kind"] = "stream";
    figures.update(stream_json(reader.header(), reader.report()));
    const std::string command = command_of(reader.header().provenance);
    figures["stretched_slots"] = stretched.slots();
    figures["mean_stretched_us"] = or_null(stretched.mean_us());
    figures["command"] = or_null(command);
    const std::string calibration = calibration_beside(file).string();
    figures["calibration_file"] = or_null(calibration);
    json.write(figures);
    run.say(stream_text(reader.header(), reader.report()));
    if (stretched.slots() > 0) run.say(stretched_text(stretched, reader));
    const std::string& provenance = reader.header().provenance;
    if (!provenance.empty()) run.say(fmt::format("provenance\n{}", provenance));
    if (!command.empty()) run.say(fmt::format("again        {}", command));
    if (!calibration.empty()) run.say(calibration_line(calibration, reader.header()));
    if (!undamaged(reader.report()))
        throw InputError(file, damage_text(reader.report()) + leftover_text(file));
    run.say(fmt::format("condition    {}{}", condition_of(reader.report()), leftover_text(file)));
}

/// What may be a stream: by its extension, or because it is no file (a pipe).
bool may_be_stream(const std::string& file) {
    const std::filesystem::path path(file);
    std::error_code error;
    const auto kind = std::filesystem::status(path, error).type();
    return path.extension() == ".stipple" || path.extension() == ".strec" ||
           kind != std::filesystem::file_type::regular;
}

void info(const InfoOptions& options, const RunOptions& run) {
    const std::string& file = options.file;
    if (!options.raw && is_rig_folder(file)) return info_rig(file, run);
    const bool ours = !options.raw && (is_recording(file) || is_stream(file));
    if (options.raw || (!ours && is_footage(file)))
        return info_footage(file, options.raw, options.header_only, run);
    if (is_chip_calibration(file)) return info_calibration(file, run);
    if (options.header_only) throw InputError(file, "--header applies to footage only");
    if (ours) return is_stream(file) ? info_stream(file, run) : info_recording(file, run);
    if (const SettingsKind kind = settings_kind(file); kind != SettingsKind::kNone)
        return info_settings(kind, file, run);
    if (may_be_stream(file)) return info_stream(file, run);
    throw InputError(
        file, fmt::format(
                  "is not a file type stipple can read: it is {}, not a sample stream, recording, "
                  "calibration, footage, sensor, schedule, rig, space or scene; frames "
                  "without a header need --raw",
                  sniff_file_type(file)));
}

}  // namespace

void add_info(Command& app, Action& action) {
    Command command = app.add_command("info", "Kind and contents of a file");
    const auto options = std::make_shared<InfoOptions>();
    command
        .add_option(
            "FILE", options->file,
            "stream, recording, calibration, footage, folder of a rig, sensor, schedule, rig "
            "or space, or the name of one")
        .required()
        .input();
    add_raw_argument(command, options->raw, "FILE");
    command.add_flag("--header", options->header_only,
                     "of footage what it declares; do not read its frames");
    command.footer(
        "Examples:\n"
        "  stipple info clip.stipple\n"
        "  stipple info clip.strec --json -\n"
        "  stipple info footage.cine --header\n"
        "  stipple info frames.raw --raw 640x480:mono12p\n"
        "  stipple info imx273\n"
        "The whole file is checked. If it is damaged, the damage is listed, the exit code is 1.");
    set_action(command, action, options, info);
}

}  // namespace stipple
