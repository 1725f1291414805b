// The six-clip video-SCI benchmark: 8 frames of 256 x 256 added up through binary masks, without
// noise. `bench_sci FOLDER --masks masks.npy` prints the PSNR of each clip beside the published
// averages; without a folder it runs on stand-ins. docs/notes/sci_benchmark.md says how to get the
// clips into it.
#include <fmt/format.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "apps/arguments/common_options.h"
#include "core/config.h"
#include "core/error.h"
#include "session/decode_setup.h"
#include "tests/bench/sci/sci_trial.h"

namespace stipple {
namespace {

struct Arguments {
    std::string folder;
    std::string masks;
    std::vector<std::string> clips = {"kobe32", "traffic48", "runner40",
                                      "drop40", "aerial32",  "crash32"};
    std::vector<std::string> methods = {"fast"};
    std::vector<std::string> kinds = {"binary"};
    std::vector<std::string> settings;
    SciSensor sensor;
    int slots = 32;
    int side = 256;
};

/// Averages over the six clips; docs/notes/sci_benchmark.md has the sources.
constexpr std::pair<const char*, double> kPublished[] = {
    {"GAP-TV", 26.93}, {"PnP-FFDNet", 29.25}, {"PnP-FastDVDnet", 31.79}, {"DeSCI", 32.65},
    {"BIRNAT", 33.31}, {"RevSCI", 33.92},     {"EfficientSCI-L", 36.87}};

NpyVolume masks_of(const std::string& kind, const Arguments& arguments, FrameShape shape) {
    if (kind == "grey") return grey_masks(shape, 1);
    NpyVolume masks =
        arguments.masks.empty() ? random_masks(shape, 1) : read_npy_volume(arguments.masks);
    return kind == "blurred" ? blurred_masks(masks) : masks;
}

std::map<std::string, FluxVideo> read_clips(const Arguments& arguments) {
    std::map<std::string, FluxVideo> clips;
    if (arguments.folder.empty()) {
        const FrameShape shape{arguments.side, arguments.side, 1};
        for (const char* scene : {"pan", "roll", "pencils", "dice", "still"})
            clips.emplace(scene, sci_stand_in(scene, arguments.slots, shape));
        return clips;
    }
    for (const std::string& name : arguments.clips)
        clips.emplace(name, read_sci_clip(arguments.folder, name));
    return clips;
}

/// One column of the table: the PSNR of each clip.
struct Column {
    std::string method;
    std::string masks;
    std::vector<double> psnr_db;
    double seconds = 0;
};

Column run_method(const std::string& name, const std::string& kind, const Arguments& arguments,
                  const std::map<std::string, FluxVideo>& clips) {
    const DecodeOptions options = read_decode_setup(name, Config(arguments.settings)).options;
    Column column{.method = name, .masks = kind, .psnr_db = {}};
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& [clip, video] : clips) {
        const NpyVolume masks = masks_of(kind, arguments, video.shape());
        column.psnr_db.push_back(sci_psnr_db(video, masks, arguments.sensor, options));
    }
    column.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return column;
}

void print_table(const std::vector<Column>& columns,
                 const std::map<std::string, FluxVideo>& clips) {
    fmt::print("| method | masks |");
    for (const auto& [name, video] : clips) fmt::print(" {} |", name);
    fmt::print(" average | s |\n|---|");
    for (std::size_t i = 0; i < clips.size() + 3; ++i) fmt::print("---|");
    for (const Column& column : columns) {
        double sum = 0;
        fmt::print("\n| {} | {} |", column.method, column.masks);
        for (const double psnr : column.psnr_db) {
            fmt::print(" {:.2f} |", psnr);
            sum += psnr;
        }
        fmt::print(" **{:.2f}** | {:.1f} |", sum / static_cast<double>(clips.size()),
                   column.seconds);
    }
    fmt::print("\n");
}

void run(const Arguments& arguments) {
    const auto clips = read_clips(arguments);
    std::vector<Column> columns;
    for (const std::string& method : arguments.methods)
        for (const std::string& kind : arguments.kinds)
            columns.push_back(run_method(method, kind, arguments, clips));
    print_table(columns, clips);
    if (arguments.folder.empty()) {
        fmt::print("\nStand-ins, not the clips of the benchmark: no published figure compares.\n");
        return;
    }
    fmt::print("\nPublished averages:");
    for (const auto& [name, psnr] : kPublished) fmt::print(" {} {:.2f}", name, psnr);
    fmt::print("\n");
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    stipple::Arguments arguments;
    stipple::CommandLine line("bench_sci", "Video-SCI benchmark; docs/notes/sci_benchmark.md");
    stipple::Command command = line.root();
    command.add_option("FOLDER", arguments.folder, "clips: NAME.npy or a folder NAME of images");
    command.add_option("--masks", arguments.masks, ".npy of 8 masks of 0 and 1 (random ones)");
    command.add_list("--clips", arguments.clips, "names in FOLDER (the six)").split_at_commas();
    command.add_list("--method", arguments.methods, "methods (fast)").split_at_commas();
    command.add_list("--set", arguments.settings, "KEY=VALUE, an option of the method");
    command.add_list("--kind", arguments.kinds, "masks: binary, grey, blurred (binary)")
        .split_at_commas()
        .one_of({"binary", "grey", "blurred"});
    command.add_flag("--noise-free", arguments.sensor.noise_free,
                     "say in the stream that the samples have no noise");
    command.add_option("--electrons", arguments.sensor.electrons_per_unit, "of light 1.0 (1e6)")
        .check(stipple::number_check(1, 1.2e6));
    command.add_option("--slots", arguments.slots, "frames of a stand-in (32)")
        .check(stipple::whole_check(8, 1000));
    command.add_option("--side", arguments.side, "pixels of a stand-in (256)")
        .check(stipple::whole_check(8, 1024));
    using Parsed = stipple::CommandLine::Parsed;
    if (const Parsed parsed = line.parse(argc, argv); parsed != Parsed::kAction)
        return parsed == Parsed::kHelp ? 0 : 2;
    try {
        stipple::run(arguments);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_sci: {}\n", e.what());
        return 1;
    }
    return 0;
}
