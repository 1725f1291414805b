#include "apps/emulate.h"

#include <fmt/format.h>

#include <filesystem>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/emulation_text.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "capture/recording/footage_notes.h"
#include "core/config.h"
#include "io/frame_writer.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "readout/coded_sensor.h"
#include "readout/footage_origin.h"
#include "readout/rig.h"
#include "readout/rig_figures.h"
#include "readout/rig_recorder.h"
#include "readout/sensor_file.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

bool is_rig_file(std::string_view name) {
    return name == kRigFile || name.ends_with(".stipple");
}

/// True at the end of the footage, false after a signal.
bool expose_all(ResampledFootage& slots, std::list<RigRecorder>& runs, FrameWriter* truth,
                Progress& progress) {
    auto frame = slots.next();
    for (; !frame.empty() && stop_signal() == 0; frame = slots.next()) {
        for (RigRecorder& sensor : runs) sensor.expose(progress.done(), frame);
        if (truth != nullptr) truth->write(frame);
        progress.advance();
    }
    return frame.empty();
}

/// The rig as it was read, with what identifies its streams.
std::string rig_text(const Config& config, const Rig& rig, const fs::path& folder) {
    std::string text = config.as_toml("");
    for (const RigSensor& sensor : rig.sensors)
        text +=
            fmt::format("{}.sha256 = \"{}\"\n", sensor.name,
                        origin_of(folder / sensor.file(), {}, [] { throw_if_stopped(); }).sha256);
    return text;
}

nlohmann::ordered_json rig_json(const std::list<RigRecorder>& runs, const RigTotals& totals,
                                double slots_per_second) {
    nlohmann::ordered_json json{{"sensors", nlohmann::ordered_json::array()}};
    for (const RigRecorder& run : runs) {
        nlohmann::ordered_json figures{{"name", run.sensor().name}, {"share", run.sensor().share}};
        figures.update(emulation_json(run.recorder(), slots_per_second));
        json["sensors"].push_back(figures);
    }
    json.update(json_of([&](const auto& add) { visit_rig_figures(totals, add); }));
    return json;
}

std::string totals_text(const RigTotals& totals) {
    return fmt::format(
        "rig: {:.1f} % of the light of an aperture collected, {} bits a slot, {} "
        "Mbit/s{}",
        100 * totals.light_collected, rounded(totals.bits_per_slot),
        rounded(totals.bits_per_second * 1e-6),
        totals.energy_uj ? fmt::format(", {} uJ", rounded(*totals.energy_uj)) : "");
}

/// Says what there is to say of each sensor and of the rig.
void tell(const EmulateArguments& arguments, const RunOptions& run, JsonFile& json,
          const std::list<RigRecorder>& runs, double slots_per_second) {
    RigTotals totals;
    for (const RigRecorder& sensor : runs) totals.add(sensor.recorder(), sensor.sensor().share);
    for (const RigRecorder& sensor : runs) {
        const StreamRecorder& recorder = sensor.recorder();
        const std::string file = (fs::path(arguments.output) / sensor.sensor().file()).string();
        say_warning(zero_warning(file, recorder.zero_fraction(),
                                 calibration_of(recorder.emulator().setup().params)));
        run.say(fmt::format("{}: {}", file, emulation_text(recorder, slots_per_second)));
    }
    run.say(totals_text(totals));
    json.write(rig_json(runs, totals, slots_per_second));
}

}  // namespace

void emulate_rig(const EmulateArguments& arguments, const RunOptions& run) {
    Config config(find_config(ConfigKind::kRigs, arguments.rig), arguments.rig_settings, "rig");
    const Rig rig = read_rig(config);
    ReadAhead footage = read_footage(arguments.source.footage, arguments.source.reading);
    const auto setups = set_up_rig(rig, footage.shape(), footage.filter());
    const SensorSetup& first = setups.front();
    say_warning(mosaic_warning(first, footage.filter()));
    for (const Message& note : sensor_notes(arguments.source.footage, footage, first.params,
                                            arguments.source.resampling.has_value()))
        say_warning(note);
    ResampledFootage slots = arguments.source.slots_of(footage, first.params.slot_us);
    JsonFile json(run);
    PendingOutput folder(arguments.output, run.force, OutputKind::kFolder, is_rig_file);
    say_leftover(arguments.output);
    std::unique_ptr<FrameWriter> truth;
    if (!arguments.truth.empty())
        truth = std::make_unique<FrameWriter>(arguments.truth, first.footage,
                                              FrameWriterOptions{.force = run.force});
    const FootageOrigin origin = arguments.source.origin([] { throw_if_stopped(); });
    std::list<RigRecorder> runs;
    for (std::size_t i = 0; i < setups.size(); ++i)
        runs.emplace_back(rig.sensors[i], setups[i], folder.partial() / rig.sensors[i].file(),
                          StreamRecorderOptions{.provenance = provenance_of(setups[i], origin)});
    Progress progress(run, "emulating", slots.slots());
    const bool at_end = expose_all(slots, runs, truth.get(), progress);
    if (progress.done() == 0) {
        throw_if_stopped();
        refuse_short_footage(arguments.source.footage);
    }
    for (RigRecorder& sensor : runs) sensor.finish(progress.done());
    if (truth) truth->finish();
    write_whole(folder.partial() / kRigFile, (fs::path(arguments.output) / kRigFile).string(),
                rig_text(config, rig, folder.partial()));
    folder.commit();
    if (at_end)
        for (const Message& note : end_notes(arguments.source.footage, footage, first.params,
                                             arguments.source.resampling.has_value()))
            say_warning(note);
    tell(arguments, run, json, runs, static_cast<double>(progress.done()) / progress.seconds());
}

}  // namespace stipple
