#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/interrupt.h"
#include "apps/json_file.h"
#include "apps/name_check.h"
#include "apps/progress.h"
#include "apps/stream_text.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/frame_writer.h"
#include "core/parallel.h"
#include "decoder/reconstruct.h"

namespace stipple {
namespace {

struct DecodeArguments {
    std::string stream;
    std::string output;
    std::string method = "fast";
    std::string options;  ///< file of the method's options; empty: none
    std::vector<std::string> settings;
    bool strict = false;
};

DecodeOptions options_of(const DecodeArguments& arguments) {
    const DecodeMethod method = decode_method_from_name(arguments.method);
    Config config = arguments.options.empty()
                        ? Config(arguments.settings)
                        : Config(find_config("decoders", arguments.options), arguments.settings);
    return read_decode_options(method, config);
}

/// The most memory of this process that has lain in RAM at a time.
std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

std::string method_help() {
    std::string names;
    for (const NamedDecodeMethod& known : decode_methods())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", known.name);
    return names + fmt::format(" ({})", DecodeArguments{}.method);
}

nlohmann::ordered_json figures_of(const DecodeReport& report, const std::string& method) {
    return {{"method", method},
            {"seconds", report.seconds},
            {"voxels", report.voxels},
            {"voxels_per_second", static_cast<double>(report.voxels) / report.seconds},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"threads", thread_count()}};
}

void decode_file(const DecodeArguments& options, const RunOptions& run) {
    const DecodeOptions method = options_of(options);
    StreamReader reader(options.stream,
                        options.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant);
    JsonFile json(run);
    FrameWriter writer(options.output, reader.header().shape, {.force = run.force});
    DecodeReport report;
    {
        Progress progress(run, "decoding", reader.slots());
        report = decode(
            reader, method,
            [&](std::int64_t, std::span<const float> frame) {
                writer.write(frame);
                return stop_signal() == 0;
            },
            [&](double slots) {
                progress.reach(slots);
                return stop_signal() == 0;
            });
    }
    if (report.slots == 0) throw_if_stopped();
    if (report.slots == 0) throw InputError(options.stream, "holds no slot to decode");
    writer.finish();
    const auto figures = figures_of(report, options.method);
    json.write(figures);
    run.say(fmt::format("{}: {} frames, method {}, {:.3g} s, {:.3g} voxels/s, {} MB",
                        options.output, report.slots, options.method, report.seconds,
                        figures["voxels_per_second"].get<double>(), peak_memory_bytes() / 1000000));
    if (!undamaged(reader.report()))
        throw InputError(options.stream,
                         damage_text(reader.report()) + "\n  the output is made of what is left");
}

}  // namespace

void add_decode(CLI::App& app, Action& action) {
    auto* command = app.add_subcommand("decode", "Sample stream to high-speed video");
    const auto options = std::make_shared<DecodeArguments>();
    command->add_option("STREAM", options->stream, "sample stream")->required();
    command
        ->add_option("-o,--output", options->output,
                     "folder (EXR, linear), .npy (linear), .mp4 or .mkv (tone-mapped)")
        ->type_name("OUT")
        ->required();
    command->add_option("--method", options->method, method_help())
        ->check(name_check(decode_method_from_name))
        ->type_name("NAME");
    command
        ->add_option("--options", options->options,
                     "options of the method: a file as docs/decoder_options.md says")
        ->type_name("FILE");
    command->add_option("--set", options->settings, "change one option of the method")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->add_flag("--strict", options->strict, "write nothing if the stream is damaged");
    command->footer(
        "Examples:\n"
        "  stipple decode clip.stipple -o decoded\n"
        "  stipple decode clip.stipple -o decoded.mp4 --method naive --threads 1\n"
        "What is intact of a damaged stream is decoded, the damage is listed, the exit code is 1.");
    command->callback([options, &action] {
        action = [options](const RunOptions& run) { decode_file(*options, run); };
    });
}

}  // namespace stipple
