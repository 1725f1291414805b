#include "apps/calibrate.h"

#include <string>

#include "apps/arguments/common_options.h"
#include "apps/arguments/settings.h"
#include "apps/interrupt.h"
#include "apps/output/progress.h"
#include "apps/standard_streams.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

/// Tells the progress and of damage, and ends the series when the program shall end.
SeriesObserver observer_of(Progress& progress) {
    return {.advance =
                [&] {
                    progress.advance();
                    throw_if_stopped();
                },
            .warn = [](const std::string& text) { say_warning("{}", text); }};
}

FieldSeries emulate_series(const SeriesArguments& arguments, const RunOptions& run) {
    const SensorParams params = set_up_params(arguments.sensor);
    CalibrationImages images = arguments.emulated;
    images.levels = arguments.levels >= 0 ? arguments.levels : default_levels(params);
    const auto exposures = calibration_exposures(params, images, arguments.sensor.seed);
    int count = 0;
    for (const CalibrationExposure& exposure : exposures) count += exposure.images;
    Progress progress(run, "exposing", count);
    return expose_series({.params = params,
                          .shape = arguments.shape,
                          .sensor = arguments.sensor.sensor,
                          .size_where = "--size"},
                         exposures, observer_of(progress));
}

}  // namespace

FieldSeries read_fields(const SeriesArguments& arguments, const RunOptions& run) {
    if (arguments.images.empty() && arguments.dark.empty()) return emulate_series(arguments, run);
    Progress progress(run, "reading", {});
    const SeriesObserver observer = observer_of(progress);
    if (!arguments.images.empty()) return read_image_series(arguments.images, observer);
    return read_field_streams({arguments.dark.begin(), arguments.dark.end()},
                              {arguments.flat.begin(), arguments.flat.end()}, observer);
}

void check_series(const Command& command, const SeriesArguments& arguments) {
    if (arguments.dark.empty() != arguments.flat.empty())
        throw UsageError(arguments.dark.empty() ? "--dark" : "--flat",
                         "streams without light and of uniform light are both needed");
    if (arguments.sensor.sensor.empty())
        command.refuse({"--set", "--size", "--planes", "--flats", "--darks", "--levels", "--seed"},
                       "is of --sensor; add that or leave this out");
    else if (arguments.shape.pixels() == 0)
        throw UsageError("--size", "width and height of the array are needed, as of the footage");
}

void add_series_arguments(Command& command, SeriesArguments& arguments) {
    command
        .add_option("--sensor", arguments.sensor.sensor,
                    "emulate the series of a sensor, of \"stipple list sensors\"")
        .type_name("NAME|FILE")
        .listed("sensors")
        .input();
    add_settings(command, {{"sensor", &arguments.sensor.settings}}, "change a key of the sensor");
    add_size(command, "--size", arguments.shape, {1, kMaxFrameSide},
             "with --sensor: width and height of its array");
    command
        .add_option("--planes", arguments.shape.planes,
                    "with --sensor: 1 mono or mosaic, 3 stacked red, green and blue")
        .shows_default()
        .check(whole_check(1, 4))
        .type_name("N");
    command
        .add_option("--flats", arguments.emulated.flats, "with --sensor: images of uniform light")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--darks", arguments.emulated.darks,
                    "with --sensor: images without light, of each of two exposure times")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--levels", arguments.levels,
                    "with --sensor: levels of light that tell its response curve")
        .default_text("12 of a sensor with response_loss or inl_dn, else 0")
        .check(whole_check(0, 1000))
        .type_name("N");
    add_seed(command, arguments.sensor.seed, "with --sensor: seed of the noise");
    command
        .add_option("--series", arguments.images,
                    "images of a camera: their descriptor (docs/characterize.md)")
        .type_name("FILE")
        .input();
    command.add_list("--dark", arguments.dark, "stream of the chip without light; may be repeated")
        .type_name("STREAM")
        .input();
    command
        .add_list("--flat", arguments.flat,
                  "stream of the chip in uniform, constant light; may be repeated, each with its "
                  "own light")
        .type_name("STREAM")
        .input();
}

}  // namespace stipple
