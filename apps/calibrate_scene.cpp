#include "apps/calibrate.h"

#include <fmt/format.h>

#include <utility>

#include "apps/arguments/common_options.h"
#include "apps/interrupt.h"
#include "apps/output/progress.h"
#include "apps/standard_streams.h"
#include "calibration/scene_gain.h"
#include "core/error.h"
#include "core/named_value.h"
#include "decoder/decode_method.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"

namespace stipple {

void add_scene_arguments(Command& command, SceneArguments& arguments) {
    command
        .add_option("--scene", arguments.stream,
                    "stream of any scene that moves: gains only, without flats")
        .type_name("STREAM")
        .input();
    command.add_option("--method", arguments.method, "with --scene: decoding method")
        .shows_default()
        .one_of(names_of(decode_methods()))
        .type_name("NAME");
    command
        .add_option("--prnu", arguments.prnu,
                    "with --scene: standard deviation of the gains, as 0.01 for 1 %")
        .default_text("that of the sensor, which the stream tells")
        .check(number_check(1e-6, 0.5))
        .type_name("FRACTION");
}

ChipCalibration calibrate_by_scene(const SceneArguments& arguments, const RunOptions& run) {
    StreamReader decoded(arguments.stream), samples(arguments.stream);
    const ChipOrigin chip = chip_of(decoded.header().provenance);
    const double prnu = arguments.prnu > 0 ? arguments.prnu : chip.prnu;
    if (!(prnu > 0))
        throw InputError(arguments.stream,
                         "does not tell how much the gains of the chip differ; give its PRNU with "
                         "--prnu (the data sheet has it)");
    Progress progress(run, "decoding", decoded.slots());
    auto calibration =
        scene_calibration(decoded, samples, {.method = decode_method_from_name(arguments.method)},
                          prnu, [&](double slots) {
                              progress.reach(slots);
                              return stop_signal() == 0;
                          });
    if (!calibration) throw Interrupted{};
    if (!undamaged(decoded.report()))
        say_warning("{}: {}", arguments.stream, damage_text(decoded.report()));
    if (chip.name.size() <= kMaxNameBytes) calibration->chip.name = chip.name;
    calibration->chip.device_id = chip.device_id;
    return std::move(*calibration);
}

}  // namespace stipple
