#include "apps/emulate.h"

#include <fmt/format.h>

#include <filesystem>
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
#include "io/frame_writer.h"
#include "readout/coded_sensor.h"
#include "readout/rig_figures.h"
#include "readout/rig_recorder.h"
#include "readout/sensor_file.h"
#include "session/rig_emulation.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// True at the end of the footage, false after a signal.
bool expose_all(ResampledFootage& slots, RigEmulation& rig, FrameWriter* truth,
                Progress& progress) {
    auto frame = slots.next();
    for (; !frame.empty() && stop_signal() == 0; frame = slots.next()) {
        rig.expose(frame);
        if (truth != nullptr) truth->write(frame);
        progress.advance();
    }
    return frame.empty();
}

nlohmann::ordered_json rig_json(const RigEmulation& rig, const RigTotals& totals,
                                double slots_per_second) {
    nlohmann::ordered_json json{{"sensors", nlohmann::ordered_json::array()}};
    for (const RigRecorder& run : rig.recorders()) {
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
          const RigEmulation& rig, double slots_per_second) {
    const RigTotals totals = rig.totals();
    for (const RigRecorder& sensor : rig.recorders()) {
        const StreamRecorder& recorder = sensor.recorder();
        const std::string file = (fs::path(arguments.output) / sensor.sensor().file()).string();
        say_warning(zero_warning(file, recorder.zero_fraction(),
                                 calibration_of(recorder.emulator().setup().params)));
        run.say(fmt::format("{}: {}", file, emulation_text(recorder, slots_per_second)));
    }
    run.say(totals_text(totals));
    json.write(rig_json(rig, totals, slots_per_second));
}

}  // namespace

void emulate_rig(const EmulateArguments& arguments, const RunOptions& run) {
    ReadAhead footage = read_footage(arguments.source.footage, arguments.source.reading);
    RigEmulation rig(arguments.rig, arguments.rig_settings, footage.shape(), footage.filter());
    const SensorSetup& first = rig.first();
    say_warning(mosaic_warning(first, footage.filter()));
    for (const Message& note : sensor_notes(arguments.source.footage, footage, first.params,
                                            arguments.source.resampling.has_value()))
        say_warning(note);
    ResampledFootage slots = arguments.source.slots_of(footage, first.params.slot_us);
    JsonFile json(run);
    rig.begin(arguments.output, run.force, arguments.source.origin([] { throw_if_stopped(); }));
    say_leftover(arguments.output);
    std::unique_ptr<FrameWriter> truth;
    if (!arguments.truth.empty())
        truth = std::make_unique<FrameWriter>(arguments.truth, first.footage,
                                              FrameWriterOptions{.force = run.force});
    Progress progress(run, "emulating", slots.slots());
    const bool at_end = expose_all(slots, rig, truth.get(), progress);
    if (progress.done() == 0) {
        throw_if_stopped();
        refuse_short_footage(arguments.source.footage);
    }
    rig.finish([] { throw_if_stopped(); });
    if (truth) truth->finish();
    if (at_end)
        for (const Message& note : end_notes(arguments.source.footage, footage, first.params,
                                             arguments.source.resampling.has_value()))
            say_warning(note);
    tell(arguments, run, json, rig, static_cast<double>(progress.done()) / progress.seconds());
}

}  // namespace stipple
