#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/arguments/common_options.h"
#include "apps/arguments/sensor.h"
#include "apps/arguments/settings.h"
#include "apps/interrupt.h"
#include "apps/output/camera_report.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/own_command.h"
#include "apps/output/progress.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/input_file.h"
#include "io/image_file.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "readout/flat_field.h"
#include "readout/sensor_file.h"
#include "sensor_model/sensor_config.h"
#include "study/metrics/emva1288/series_evaluation.h"
#include "study/report/chart.h"
#include "study/report/run_report.h"

namespace stipple {
namespace {

struct CharacterizeOptions {
    SensorChoice sensor;
    std::string descriptor;  ///< of existing images; empty: images of the sensor
    std::string output;      ///< folder; may be empty if there is a descriptor
};

/// Name of the descriptor in the folder of a series.
constexpr auto kDescriptorName = "emva1288_data.txt";
constexpr auto kPageName = "report.html";

std::string image_name(int number) {
    return fmt::format("image_{:04}.png", number);
}

/// image_0001.png ...
bool is_image_name(std::string_view name) {
    int number = 0;
    const auto [end, error] = std::from_chars(name.data() + std::min<std::size_t>(name.size(), 6),
                                              name.data() + name.size(), number);
    return error == std::errc() && name == image_name(number);
}

/// Of the charts and the page of them.
bool is_result_name(std::string_view name) {
    return name == "photon_transfer.png" || name == "photon_transfer.svg" || name == kPageName;
}

bool is_series_name(std::string_view name) {
    return is_result_name(name) || name == kDescriptorName || is_image_name(name);
}

/// Writes images of the emulated sensor, DN as 16-bit PNG, and their descriptor.
void capture_flat_fields(const SensorChoice& sensor, const SensorParams& params,
                         const PendingOutput& folder, const RunOptions& run) {
    FlatField field(params, sensor.seed);
    const auto exposures = flat_field_exposures(params);
    int images = 0;
    for (const FlatFieldExposure& exposure : exposures) images += exposure.images;
    Progress progress(run, "capturing flat fields", images);
    emva1288::Series series{.bits = params.bit_depth,
                            .cols = FlatField::kShape.cols,
                            .rows = FlatField::kShape.rows,
                            .groups = {}};
    int number = 0;
    for (const auto& [photons, count] : exposures) {
        emva1288::ImageGroup& group =
            series.groups.emplace_back(emva1288::ImageGroup{.exposure_ns = params.slot_us * 1000,
                                                            .photons = photons,
                                                            .dark = photons == 0,
                                                            .files = {}});
        for (int i = 0; i < count; ++i) {
            throw_if_stopped();
            const std::string& name = group.files.emplace_back(image_name(++number));
            write_dn_png(folder.partial() / name, (folder.final_path() / name).string(),
                         FlatField::kShape, field.capture(photons));
            progress.advance();
        }
    }
    write_whole(folder.partial() / kDescriptorName,
                (folder.final_path() / kDescriptorName).string(), series_text(series));
}

/// Reads the images that a descriptor names and evaluates them; messages call it `where`.
emva1288::Evaluation evaluate(const std::filesystem::path& descriptor, const std::string& where,
                              const RunOptions& run) {
    Progress progress(run, "evaluating", {});
    const auto bytes = read_file(descriptor);
    const emva1288::Series series =
        emva1288::parse_series({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, where);
    const auto read = [&](const std::filesystem::path& file) -> emva1288::SeriesImage {
        throw_if_stopped();
        DnImage image = read_dn_image(file);
        progress.advance();
        return {image.shape.rows, image.shape.cols, std::move(image.dn)};
    };
    return emva1288::evaluate(series, descriptor.parent_path(), read, where);
}

/// A chart or page of the folder. False if it cannot be written; `failure` is then why, unless
/// another one failed before.
bool write_result(const PendingOutput& folder, const std::string& name, std::string_view content,
                  std::optional<DeviceError>& failure) {
    try {
        write_whole(folder.partial() / name, (folder.final_path() / name).string(), content);
    } catch (const DeviceError& e) {
        if (!failure) failure = e;
        return false;
    }
    return true;
}

std::string page_of(const CameraReport& camera, const std::string& title) {
    return camera_page(title, own_command(), camera_json(camera).dump());
}

/// Draws the charts into the folder, and a page of them, as far as they can be. Returns how many
/// files there are; `failure` is why there are not more, unless that is that there is no gnuplot,
/// which is a warning.
std::size_t draw_charts(const CameraReport& camera, const std::string& title,
                        const PendingOutput& folder, std::optional<DeviceError>& failure) {
    std::size_t drawn = 0;
    try {
        for (const auto& [name, content] : photon_transfer_charts(camera.evaluation))
            if (write_result(folder, name, content, failure)) ++drawn;
    } catch (const NoGnuplot& e) {
        say_warning("{}: no charts are drawn: {}", folder.final_path().string(), e.what());
    } catch (const DeviceError& e) {
        failure = e;
    }
    if (write_result(folder, kPageName, page_of(camera, title), failure)) ++drawn;
    return drawn;
}

/// Prints the figures, then a message on charts that failed.
void report(const CameraReport& camera, const std::optional<DeviceError>& failure, JsonFile& json,
            const RunOptions& run) {
    say_warning(emva1288::bias_warning(camera.evaluation));
    json.write(camera_json(camera));
    run.say(camera_text(camera));
    if (failure) throw DeviceError(*failure);
}

/// Without --output the images lie in a temporary folder meanwhile.
void characterize_sensor(const CharacterizeOptions& options, const RunOptions& run) {
    const SensorParams params = set_up_params(options.sensor);
    JsonFile json(run);
    const bool is_kept = !options.output.empty();
    const std::filesystem::path output = is_kept ? std::filesystem::path(options.output)
                                                 : std::filesystem::temp_directory_path() /
                                                       fmt::format("stipple_series_{}", ::getpid());
    PendingOutput folder(output, run.force, OutputKind::kFolder, is_series_name);
    if (is_kept) say_leftover(options.output);
    capture_flat_fields(options.sensor, params, folder, run);
    const auto where = (folder.final_path() / kDescriptorName).string();
    const CameraReport camera{evaluate(folder.partial() / kDescriptorName, where, run),
                              configured_figures(params)};
    std::optional<DeviceError> failure;
    if (is_kept) {
        draw_charts(camera, fmt::format("Sensor {}", params.name), folder, failure);
        folder.commit();
    }
    report(camera, failure, json, run);
}

void characterize_images(const CharacterizeOptions& options, const RunOptions& run) {
    JsonFile json(run);
    std::optional<PendingOutput> folder;
    if (!options.output.empty())
        folder.emplace(options.output, run.force, OutputKind::kFolder, is_result_name);
    const CameraReport camera{evaluate(options.descriptor, options.descriptor, run), {}};
    std::optional<DeviceError> failure;
    if (folder && draw_charts(camera, options.descriptor, *folder, failure) > 0) folder->commit();
    report(camera, failure, json, run);
}

void characterize(const CharacterizeOptions& options, const RunOptions& run) {
    options.descriptor.empty() ? characterize_sensor(options, run)
                               : characterize_images(options, run);
}

}  // namespace

void add_characterize(Command& app, Action& action) {
    Command command = app.add_command("characterize", "EMVA 1288 figures of a sensor or camera");
    const auto options = std::make_shared<CharacterizeOptions>();
    const auto sensor = add_sensor(command, options->sensor.sensor);
    const auto set = add_settings(command, {{"sensor", &options->sensor.settings}},
                                  "change a key of the sensor");
    const auto seed = add_seed(command, options->sensor.seed, "seed of the noise");
    const auto threads = add_threads(command, action.options);
    command
        .add_option("--evaluate", options->descriptor, "evaluate existing images: their descriptor")
        .type_name("FILE")
        .excludes(sensor)
        .excludes(set)
        .excludes(seed)
        .excludes(threads)
        .input();
    command
        .add_option("-o,--output", options->output,
                    "folder for images, descriptor, charts and page")
        .default_text("none: figures only")
        .type_name("DIR")
        .output();
    command.footer(
        "Examples:\n"
        "  stipple characterize --sensor grasshopper -o series\n"
        "  stipple characterize --sensor t6 --set sensor.temperature_c=60 -o warm --json "
        "figures.json\n"
        "  stipple characterize --evaluate camera/emva1288_data.txt -o charts");
    set_action(command, action, options, characterize);
}

}  // namespace stipple
