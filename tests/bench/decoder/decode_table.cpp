// Speed, memory and quality of every decoding method, clip by clip: the figures of
// docs/notes/decoder_experiments.md. Each method runs in a process of its own, on the same
// recording (seed 1, colour as luminance, light clipped at 2.0). Quality is without the first and
// last 4 frames, of light up to what the shortest exposure can hold.
#include "tests/bench/decoder/decode_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>

#include "apps/arguments/command_line.h"
#include "apps/arguments/common_options.h"
#include "decoder/decode_options.h"
#include "io/npy_file.h"
#include "study/scenes/scene.h"
#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

struct TableOptions {
    std::vector<std::string> clips = {"mouse250_a", "mouse250_b",  "nat30_blocks", "nat30_coffee",
                                      "hdr_desk",   "hdr_desk_fg", "hdr_stilllife"};
    std::vector<std::string> methods;
    std::vector<std::string> settings;  ///< "method.key=value"
    std::vector<std::string> schedules = {"random"};
    std::vector<std::string> sensors = {"paper"};
    std::vector<std::string> sensor_settings;  ///< "key=value"
    std::vector<double> lights = {1};          ///< factors of the photons of light 1.0
    bool frozen = false;
    int side_px = 96;
    int slots = 24;
    bool scaling = false;
    bool one_thread = false;
};

FluxVideo rendered(const std::string& name, int side_px, int slots) {
    const FrameShape shape{.rows = side_px, .cols = side_px, .planes = 1};
    const Scene scene(scene_from_name(name), {.slots = slots, .shape = shape, .time_samples = 1});
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot) {
        scene.render(slot, video.frame(slot));
        for (float& light : video.frame(slot)) light = std::min(light, 2.0F);
    }
    return video;
}

/// The middle of the first slots.
FluxVideo cropped(const FluxVideo& video, int side_px, int slots) {
    const FrameShape from = video.shape();
    const FrameShape shape{.rows = std::min(side_px, from.rows),
                           .cols = std::min(side_px, from.cols),
                           .planes = from.planes};
    FluxVideo crop(std::min(slots, video.slots()), shape);
    const auto left = static_cast<std::size_t>((from.cols - shape.cols) / 2);
    for (int slot = 0; slot < crop.slots(); ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row) {
                const auto line = video.plane(slot, plane).row(row + (from.rows - shape.rows) / 2);
                std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(left), shape.cols,
                            crop.plane(slot, plane).row(row).begin());
            }
    return crop;
}

/// A clip of the footage folder or a scene; nothing if there is no such footage.
std::optional<FluxVideo> clip_of(const std::string& name, const TableOptions& options) {
    for (const char* scene : {"pan", "roll", "pencils", "dice", "still"})
        if (name == scene) return rendered(name, options.side_px, options.slots);
    const auto video = luminance_clip(name);
    if (!video) return {};
    return cropped(*video, options.side_px, options.slots);
}

/// Every slot becomes the first one.
void freeze(FluxVideo& video) {
    for (int slot = 1; slot < video.slots(); ++slot)
        std::ranges::copy(video.frame(0), video.frame(slot).begin());
}

/// What a clip is recorded with.
struct Camera {
    std::string schedule = "random";
    std::string sensor_name = "paper";
    double light = 1;
    SensorParams sensor = {};

    /// For the table; what is usual is not said.
    [[nodiscard]] std::string text() const {
        std::string text;
        if (schedule != "random") text += " " + schedule;
        if (sensor_name != "paper") text += " " + sensor_name;
        if (light != 1) text += fmt::format(" light {}", light);
        return text;
    }
};

std::vector<Camera> cameras_of(const TableOptions& options) {
    std::vector<Camera> cameras;
    for (const std::string& schedule : options.schedules)
        for (const std::string& sensor : options.sensors)
            for (const double light : options.lights)
                cameras.push_back(
                    {schedule, sensor, light, sensor_of(sensor, options.sensor_settings, light)});
    return cameras;
}

RecordedClip record(const FluxVideo& video, const Camera& camera,
                    const std::filesystem::path& folder) {
    const RecordedClip clip{folder / "clip.stipple", folder / "truth.npy",
                            std::min(2.0, clipping_light(camera.sensor))};
    std::filesystem::remove(clip.stream);
    write_recording(video, schedule_of(camera.schedule, video.shape()), camera.sensor, clip.stream);
    NpyWriter truth(clip.truth, clip.truth.string(), video.shape());
    for (int slot = 0; slot < video.slots(); ++slot) truth.write(video.frame(slot));
    truth.finish();
    return clip;
}

std::vector<std::string> settings_of(const std::string& method, const TableOptions& options) {
    std::vector<std::string> settings;
    for (const std::string& setting : options.settings)
        if (setting.starts_with(method + "."))
            settings.push_back(setting.substr(method.size() + 1));
    return settings;
}

void print_row(const std::string& clip, const std::string& method, const MethodFigures& f,
               double reference_rate) {
    fmt::print("| {} | {} | {:.4g} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} |\n", clip, method,
               f.voxels_per_second,
               reference_rate > 0 ? fmt::format("{:.3g}", f.voxels_per_second / reference_rate)
                                  : std::string("-"),
               f.psnr_db, f.psnr_gamma_db, f.pu21_psnr_db, static_cast<double>(f.peak_bytes) / 1e6);
    std::fflush(stdout);
}

/// The figures of each method, clip by clip.
using Figures = std::map<std::string, std::vector<MethodFigures>>;

/// All methods on a clip.
void print_clip(const std::string& name, const FluxVideo& video, const Camera& camera,
                const TableOptions& options, Figures& all) {
    const TemporaryFolder folder;
    const RecordedClip clip = record(video, camera, folder.path());
    std::map<std::string, MethodFigures> figures;
    for (const std::string& method : options.methods) {
        figures[method] =
            measure_apart(clip, {method, settings_of(method, options), options.one_thread});
        all[method].push_back(figures[method]);
    }
    const auto reference = figures.find("portz2013");
    for (const std::string& method : options.methods)
        print_row(fmt::format("{} {}x{}x{}{}{}", name, video.shape().rows, video.shape().cols,
                              video.slots(), options.frozen ? " frozen" : "", camera.text()),
                  method, figures[method],
                  reference == figures.end() ? 0 : reference->second.voxels_per_second);
}

MethodFigures mean_of(const std::vector<MethodFigures>& list) {
    MethodFigures sum;
    const auto n = static_cast<double>(list.size());
    for (const MethodFigures& f : list) {
        sum.voxels_per_second += f.voxels_per_second / n;
        sum.psnr_db += f.psnr_db / n;
        sum.psnr_gamma_db += f.psnr_gamma_db / n;
        sum.pu21_psnr_db += f.pu21_psnr_db / n;
        sum.peak_bytes = std::max(sum.peak_bytes, f.peak_bytes);
    }
    return sum;
}

/// All methods on all clips with each camera, then their means.
void print_table(const TableOptions& options) {
    fmt::print(
        "| clip | method | voxels/s | x portz2013 | PSNR dB | 1/2.2 dB | PU21 dB | MB |\n"
        "|---|---|---|---|---|---|---|---|\n");
    std::vector<std::pair<std::string, FluxVideo>> videos;
    for (const std::string& name : options.clips) {
        auto video = clip_of(name, options);
        if (!video) {
            fmt::print("| {} | not in the footage folder |\n", name);
            continue;
        }
        if (options.frozen) freeze(*video);
        videos.emplace_back(name, std::move(*video));
    }
    for (const Camera& camera : cameras_of(options)) {
        Figures all;
        for (const auto& [name, video] : videos) print_clip(name, video, camera, options, all);
        const auto reference = all.find("portz2013");
        for (const std::string& method : options.methods)
            if (!all[method].empty())
                print_row(
                    "mean; most MB" + camera.text(), method, mean_of(all[method]),
                    reference == all.end() ? 0 : mean_of(reference->second).voxels_per_second);
    }
}

/// Time for a voxel of scenes of four sizes.
void print_scaling(const TableOptions& options) {
    const TemporaryFolder folder;
    fmt::print(
        "| pan, {} slots | method | voxels | s | us/voxel | MB |\n|---|---|---|---|---|---|\n",
        options.slots);
    for (const int side_px : {64, 128, 256, 512}) {
        const FluxVideo video = rendered("pan", side_px, options.slots);
        const RecordedClip clip = record(video, cameras_of(options).front(), folder.path());
        for (const std::string& method : options.methods) {
            const MethodFigures f =
                measure_apart(clip, {method, settings_of(method, options), options.one_thread});
            fmt::print("| {}x{} | {} | {} | {:.2f} | {:.3f} | {:.0f} |\n", side_px, side_px, method,
                       video.voxels(), f.seconds, 1e6 / f.voxels_per_second,
                       static_cast<double>(f.peak_bytes) / 1e6);
            std::fflush(stdout);
        }
    }
}

/// Of "1,4,0.1".
std::vector<double> factors(const std::string& text) {
    std::vector<double> factors;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) factors.push_back(std::stod(part));
    return factors;
}

int run(int argc, char** argv) {
    TableOptions options;
    for (const NamedDecodeMethod& known : decode_methods())
        if (known.check_schedule == nullptr && known.method != DecodeMethod::kHitomi2011)
            options.methods.emplace_back(known.name);
    const auto all_methods = options.methods;
    CommandLine line("bench_decode",
                     "Speed, memory and quality of the decoding methods, as a table");
    Command command = line.root();
    command.add_list("--clips", options.clips, "clips of the footage folder, or scenes")
        .split_at_commas();
    command
        .add_list(
            "--methods", options.methods,
            "of `stipple decode` (all that take any schedule, without hitomi2011, which needs "
            "--set hitomi2011.dictionary=FILE)")
        .split_at_commas()
        .one_of(names_of(decode_methods()));
    command.add_list("--set", options.settings, "METHOD.KEY=VALUE");
    command.add_list("--schedules", options.schedules, "of config/schedules (random)")
        .split_at_commas();
    command.add_list("--sensors", options.sensors, "of config/sensors (paper)").split_at_commas();
    command.add_list("--set-sensor", options.sensor_settings, "KEY=VALUE of all sensors");
    command.add_parsed(
        "--lights", [&](const std::string& text) { options.lights = factors(text); },
        "factors of the photons of light 1.0 (1)");
    command.add_flag("--frozen", options.frozen, "every slot shows the first one");
    command.add_option("--size", options.side_px, "side of the crop, pixels (96)")
        .check(whole_check(8, 4096));
    command.add_option("--slots", options.slots, "first slots of the clip (24)")
        .check(whole_check(1, 100000));
    command.add_flag("--scaling", options.scaling,
                     "time for a voxel of four sizes instead; all methods but portz2013");
    command.add_flag("--one-thread", options.one_thread,
                     "one thread, and rates by its processor time, for a machine that is busy");
    if (const auto parsed = line.parse(argc, argv); parsed != CommandLine::Parsed::kAction)
        return parsed == CommandLine::Parsed::kHelp ? 0 : 2;
    if (options.scaling && options.methods == all_methods)
        std::erase(options.methods, std::string("portz2013"));
    options.scaling ? print_scaling(options) : print_table(options);
    return 0;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    try {
        const std::vector<std::string> arguments(argv + 1, argv + argc);
        if (arguments.size() >= 6 && arguments[0] == "--child") {
            stipple::decode_and_print(
                {arguments[1], arguments[2], std::stod(arguments[3])},
                {arguments[4], {arguments.begin() + 6, arguments.end()}, arguments[5] == "1"});
            return 0;
        }
        return stipple::run(argc, argv);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_decode: {}\n", e.what());
        return 1;
    }
}
