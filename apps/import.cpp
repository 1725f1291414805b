#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "io/output_names.h"
#include "readout/measured_stream.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

struct ImportOptions {
    MeasuredArrays arrays;
    MeasuredFiles files;
    std::string output;
    double electrons = 1000;
    bool noise_free = false;
    double saturation = 0;
};

void import(const ImportOptions& options, const RunOptions& run) {
    JsonFile json(run);
    MeasuredArrays arrays = options.arrays;
    read_measured_files(options.files, arrays);
    if (!options.noise_free) arrays.electrons = options.electrons;
    if (options.saturation > 0) arrays.saturation = options.saturation;
    const ImportedStream stream = import_measurements(arrays, options.output, run.force);
    const ExposureSchedule& schedule = stream.header.schedule;
    run.say(fmt::format("{}: {} of {} x {} pixels, {} {} masks, light 1.0 is {:g}", options.output,
                        counted(stream.measurements, "measurement"), stream.header.shape.cols,
                        stream.header.shape.rows, schedule.period_slots(),
                        schedule.weighted() ? "grey" : "binary", stream.light));
    say_warning(std::string_view(unread_text(stream, arrays.mask_file)));
    json.write(json_of([&](const auto& add) { visit_import_figures(stream, add); }));
}

void add_units(Command& command, ImportOptions& options) {
    MeasuredArrays& arrays = options.arrays;
    command.add_option("--light", arrays.light, "measurement of light 1.0 in one slot of weight 1")
        .default_text("255 if some light would be above 1.0 otherwise, else 1")
        .check(positive_check())
        .type_name("VALUE");
    command.add_option("--white", arrays.white, "value of the masks that is weight 1")
        .default_text("255 or 65535 if masks are whole numbers above 1, as in images, else 1")
        .check(positive_check())
        .type_name("VALUE");
    command
        .add_option("--electrons", options.electrons,
                    "photo-electrons of light 1.0 in one slot of weight 1, for the shot noise")
        .shows_default()
        .check(number_check(1e-3, 1e9))
        .type_name("E");
    command.add_option("--read-noise", arrays.read_noise_e, "read noise in electrons")
        .shows_default()
        .check(number_check(0, 1e9))
        .type_name("E");
    command.add_flag("--noise-free", options.noise_free,
                     "the measurements have no noise, as those of a simulation");
    command
        .add_option("--saturation", options.saturation,
                    "measurements from this value on are clipped")
        .default_text("none is")
        .check(positive_check())
        .type_name("VALUE");
}

}  // namespace

void add_import(Command& app, Action& action) {
    Command command =
        app.add_command("import", "Measurements of a coded aperture with its masks to a stream");
    const auto options = std::make_shared<ImportOptions>();
    MeasuredArrays& arrays = options->arrays;
    command
        .add_option("MEASUREMENTS", options->files.measurements,
                    ".npy or .npz of (measurements, rows, columns) or (rows, columns), or .mat of "
                    "(rows, columns, measurements)")
        .required()
        .input();
    command
        .add_option("--masks", options->files.masks,
                    ".npy or .npz of (slots, rows, columns), or .mat of (rows, columns, slots): "
                    "weights of the slots that a measurement adds up")
        .default_text("MEASUREMENTS, if that is a .npz or .mat")
        .type_name("FILE")
        .input();
    command
        .add_option("--slots", options->files.slots,
                    "slots of a measurement: the first N of the masks")
        .default_text("as many as there are masks")
        .check(whole_check(1, kMaxPeriodSlots))
        .type_name("N");
    add_output(command, options->output, "sample stream", kStreamName);
    add_units(command, *options);
    command
        .add_choice("--cfa", arrays.cfa,
                    {{"none", ColourFilter::kNone},
                     {"rggb", ColourFilter::kRggb},
                     {"grbg", ColourFilter::kGrbg},
                     {"gbrg", ColourFilter::kGbrg},
                     {"bggr", ColourFilter::kBggr}},
                    "colour filter array of the camera")
        .type_name("NAME");
    command.add_option("--slot-us", arrays.slot_us, "length of a slot in microseconds")
        .shows_default()
        .check(number_check(1e-6, 1e12))
        .type_name("US");
    command
        .add_option("--variable", options->files.variable,
                    "name of the measurements in a .npz or .mat")
        .shows_default()
        .type_name("NAME");
    command
        .add_option("--mask-variable", options->files.mask_variable,
                    "name of the masks in a .npz or .mat")
        .shows_default()
        .type_name("NAME");
    command.footer(
        "Examples:\n"
        "  stipple import meas.npy --masks masks.npy -o clip.stipple --electrons 5000\n"
        "  stipple import meas_cr_10.mat --masks real_mask.mat --slots 10 -o clip.stipple\n"
        "  stipple import kobe32_cacti.mat -o kobe.stipple --noise-free\n"
        "  stipple decode clip.stipple -o decoded");
    set_action(command, action, options, import, [command, options] {
        if (options->noise_free)
            command.refuse({"--electrons", "--read-noise"}, "is of noise; --noise-free has none");
    });
}

}  // namespace stipple
