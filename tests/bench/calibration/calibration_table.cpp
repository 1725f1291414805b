// Quality of a chip with fixed pattern, without calibration and with calibrations of some frames,
// and of the same chip without fixed pattern, linear: the table of docs/calibration.md.
// `bench_calibration [CLIP] [SIDE]` (mouse250_a 128).
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "calibration/scene_gain.h"
#include "core/error.h"
#include "decoder/decode_options.h"
#include "stream/stream_reader.h"
#include "tests/pipeline/chip_sites.h"
#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr int kSlots = 32;

struct Chip {
    std::string text;
    std::string sensor;
    std::vector<std::string> settings;
    int levels;  ///< of light, for the response curve
};

std::vector<Chip> chips() {
    constexpr int kLevels = 12;
    return {{.text = "`t6`", .sensor = "t6", .settings = {}, .levels = 0},
            {.text = "`grasshopper`", .sensor = "grasshopper", .settings = {}, .levels = 0},
            {.text = "`t6`, `response_loss=0.1`",
             .sensor = "t6",
             .settings = {"response_loss=0.1"},
             .levels = kLevels},
            {.text = "`t6`, `response_loss=0.3`",
             .sensor = "t6",
             .settings = {"response_loss=0.3"},
             .levels = kLevels}};
}

/// PSNR of a decoding, linear and after 1/2.2, and its seconds.
std::string cell(const FluxVideo& video, const SensorParams& sensor, DecodeMethod method,
                 const ChipCalibration& chip) {
    const TemporaryFolder folder;
    write_recording(video, schedule_of("random", video.shape()), sensor, folder / "clip.stipple");
    const auto begin = std::chrono::steady_clock::now();
    const FluxVideo decoded =
        read_recording(folder / "clip.stipple", method, chip.sites, chip.response);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const VideoQuality quality = quality_of(decoded, video);
    return fmt::format("{:.2f} / {:.2f} ({:.1f} s)", quality.psnr_db, quality.psnr_gamma_db,
                       seconds);
}

/// The gains that the clip itself gives.
ChipCalibration calibration_of_scene(const FluxVideo& video, const SensorParams& sensor) {
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    write_recording(video, schedule_of("random", video.shape()), sensor, file);
    StreamReader decoded(file), samples(file);
    return *scene_calibration(decoded, samples, DecodeOptions{}, sensor.physical.prnu);
}

void print_table(const FluxVideo& video) {
    fmt::print(
        "| sensor | method | no fixed pattern | not calibrated | scene | 25 flats | 100 flats |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const Chip& chip : chips()) {
        const SensorParams sensor = sensor_of(chip.sensor, chip.settings);
        const auto calibrated = [&](int images) {
            return calibrated_chip(sensor, video.shape(),
                                   {.darks = images, .flats = images, .levels = chip.levels})
                .calibration;
        };
        const ChipCalibration few = calibrated(25), many = calibrated(100);
        const ChipCalibration scene = calibration_of_scene(video, sensor);
        for (const std::string method : {"fast", "best"}) {
            const DecodeMethod decoding = decode_method_from_name(method);
            fmt::print("| {} | `{}` | {} | {} | {} | {} | {} |\n", chip.text, method,
                       cell(video, without_fixed_pattern(sensor), decoding, {}),
                       cell(video, sensor, decoding, {}), cell(video, sensor, decoding, scene),
                       cell(video, sensor, decoding, few), cell(video, sensor, decoding, many));
            std::fflush(stdout);  // rows take a while
        }
    }
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string clip = arguments.empty() ? "mouse250_a" : arguments[0];
    const int side = arguments.size() < 2 ? 128 : std::atoi(arguments[1].c_str());
    try {
        const auto video = stipple::luminance_clip(clip);
        if (!video || side < 1) {
            fmt::print(stderr, "no clip {} of {} pixels\n", clip, side);
            return 1;
        }
        stipple::print_table(stipple::middle(*video, side, stipple::kSlots));
    } catch (const stipple::InputError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
