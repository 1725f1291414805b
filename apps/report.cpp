#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/camera_report.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/output_names.h"
#include "io/text_file.h"
#include "study/report/run_report.h"
#include "study/report/stream_text.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

struct ReportArguments {
    std::vector<std::string> runs;
    std::string output = "report.html";
    std::string truth;   ///< empty: none
    std::string camera;  ///< figures of `characterize`; empty: none
    std::string method = "fast";
    FootageOptions footage;  ///< of the truth
    RunReportOptions page;
};

bool exposes_alike(const fs::path& stream) {
    const StreamReader reader(stream);
    const ExposureSchedule& schedule = reader.header().schedule;
    return schedule.tile_rows() == 1 && schedule.tile_cols() == 1;
}

/// The streams in a folder, by name, those of conventional cameras last.
std::vector<fs::path> streams_in(const fs::path& folder) {
    std::vector<fs::path> streams;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".stipple" && entry.is_regular_file() &&
            !entry.path().filename().string().starts_with('.'))
            streams.push_back(entry.path());
    if (streams.empty()) throw InputError(folder.string(), "holds no sample stream (.stipple)");
    std::ranges::sort(streams);
    std::stable_partition(streams.begin(), streams.end(),
                          [](const fs::path& s) { return !exposes_alike(s); });
    return streams;
}

std::vector<fs::path> streams_of(const std::vector<std::string>& runs) {
    std::vector<fs::path> streams;
    for (const std::string& run : runs) {
        if (!fs::is_directory(run)) {
            if (fs::exists(run) && !fs::is_regular_file(run))
                throw InputError(run,
                                 "cannot be read several times, as a report needs; record to a "
                                 "file first");
            streams.emplace_back(run);
            continue;
        }
        const auto inside = streams_in(run);
        streams.insert(streams.end(), inside.begin(), inside.end());
    }
    return streams;
}

/// The first frames of the truth. \throws InputError if they have another shape.
FluxVideo read_truth(const ReportArguments& arguments, FrameShape shape) {
    ReadAhead footage = read_footage(arguments.truth, arguments.footage);
    if (footage.shape() != shape)
        throw InputError(arguments.truth,
                         shape_difference(footage.shape(), shape, "the runs have"));
    constexpr std::uint64_t kValueBytes = 2 * sizeof(float);  // here, and in the video
    const std::uint64_t bytes = input_bytes(arguments.truth);
    std::vector<float> light;
    std::int64_t slots = 0;
    for (auto frame = footage.next(); !frame.empty() && slots < arguments.page.slots;
         frame = footage.next()) {
        throw_if_stopped();
        check_memory(kValueBytes * (light.size() + frame.size()), arguments.truth,
                     "the truth of a report", bytes);
        light.insert(light.end(), frame.begin(), frame.end());
        ++slots;
    }
    FluxVideo truth(static_cast<int>(slots), shape);
    std::ranges::copy(light, truth.data().begin());
    return truth;
}

/// Decodes the first slots of a stream. `put` takes slot and frame.
template <typename Put>
void decode_slots(const fs::path& stream, DecodeMethod method, std::int64_t slots,
                  const RunOptions& run, const Put& put) {
    StreamReader reader(stream);
    DecodeOptions options;
    options.method = method;
    Progress progress(run, fmt::format("{}, {}", stream.filename().string(), named(method).name),
                      std::min(reader.slots().value_or(slots), slots));
    decode(
        reader, options,
        [&](std::int64_t slot, std::span<const float> frame) {
            put(slot, frame);
            return slot + 1 < slots && stop_signal() == 0;
        },
        [&](double done) {
            progress.reach(done);
            return stop_signal() == 0;
        });
    throw_if_stopped();
}

/// A stream in the report.
struct ShownStream {
    fs::path file;
    std::string name;    ///< without extension; with its folder where two files have the same
    std::size_t number;  ///< RunReport::add_run
};

/// All of them before the first is decoded, so that one that does not fit ends the run at once.
std::vector<ShownStream> add_streams(RunReport& report, const std::vector<fs::path>& files) {
    std::vector<ShownStream> streams;
    streams.reserve(files.size());
    for (const fs::path& file : files) {
        const auto same = std::ranges::count_if(
            files, [&](const fs::path& other) { return other.stem() == file.stem(); });
        const std::string name =
            (same == 1 ? file.stem() : file.parent_path() / file.stem()).string();
        throw_if_stopped();
        streams.push_back({file, name, report.add_run(file, name)});
    }
    return streams;
}

/// A stream by the naive method, which shows what the samples are, and by the chosen one, whose
/// video it returns.
std::size_t add_videos(RunReport& report, const ShownStream& stream,
                       const ReportArguments& arguments, const RunOptions& run) {
    const DecodeMethod chosen = decode_method_from_name(arguments.method);
    std::vector<DecodeMethod> methods{DecodeMethod::kNaive};
    if (chosen != DecodeMethod::kNaive) methods.push_back(chosen);
    std::size_t video = 0;
    for (const DecodeMethod method : methods) {
        const std::string by(named(method).name);
        video = report.add_video({fmt::format("{}, {}", stream.name, by),
                                  fmt::format("{} decoded by {}", stream.name, by), stream.number});
        decode_slots(stream.file, method, arguments.page.slots, run,
                     [&](std::int64_t slot, auto frame) { report.put(video, slot, frame); });
    }
    return video;
}

RunReportOptions page_options(const ReportArguments& arguments,
                              const std::vector<fs::path>& streams,
                              const std::optional<FluxVideo>& truth) {
    RunReportOptions options = arguments.page;
    options.command = own_command();
    if (!options.quality.max_value) {
        double brightest = 0;
        for (const fs::path& stream : streams)
            brightest = std::max(brightest, brightest_light(StreamReader(stream).header()));
        if (brightest > 0) options.quality.max_value = brightest;
    }
    if (truth) options.quality.margin = usual_margin(truth->slots());
    return options;
}

void make_report(const ReportArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(arguments.output, run.force);
    const auto streams = streams_of(arguments.runs);
    const FrameShape shape = decoded_shape(StreamReader(streams.front()).header());
    std::optional<FluxVideo> truth;
    if (!arguments.truth.empty()) truth = read_truth(arguments, shape);
    RunReport report(page_options(arguments, streams, truth), shape, truth ? &*truth : nullptr);
    if (!arguments.camera.empty()) report.set_camera(read_camera_file(arguments.camera).dump());
    std::vector<std::size_t> decoded;
    decoded.reserve(streams.size());
    for (const ShownStream& stream : add_streams(report, streams))
        decoded.push_back(add_videos(report, stream, arguments, run));
    report.feature(decoded.front());
    report.fit();
    const auto data = nlohmann::ordered_json::parse(report.json());
    const std::string page = report.page();
    write_text(output, page);
    for (const std::string& note : report.notes()) say_warning(note);
    say_warning(chart_warning());
    json.write({{"file", arguments.output},
                {"bytes", page.size()},
                {"slots", data["slots"]},
                {"picture_step", data["picture_step"]},
                {"area", data["area"]},
                {"quality_options", data["quality_options"]},
                {"videos", data["videos"]},
                {"notes", report.notes()}});
    run.say(fmt::format("{}: {} of {}, {:.1f} MB", arguments.output,
                        counted(data["videos"].size(), "video"), counted(streams.size(), "run"),
                        1e-6 * static_cast<double>(page.size())));
    if (const std::string damage = report.damage(); !damage.empty())
        throw InputError(arguments.output,
                         "shows only the undamaged part of damaged streams: " + damage);
}

void add_limits(Command& command, const std::shared_ptr<ReportArguments>& options) {
    command.add_option("--until", options->page.slots, "only the first N slots")
        .shows_default()
        .check(whole_check(std::int64_t{1}, std::int64_t{100'000}))
        .type_name("N");
    command
        .add_parsed(
            "--crop",
            [options](const std::string& text) {
                options->page.area = parse_area(text);
                if (!options->page.area)
                    throw UsageError("--crop", "\"" + text + "\" is not WxH or WxH+X+Y in pixels");
            },
            "area of the pictures: width, height, first column, first row")
        .default_text("all, or 640x480 of the middle")
        .type_name("WxH+X+Y");
    command
        .add_parsed(
            "--max-size",
            [options](const std::string& text) {
                const auto bytes = parse_memory(text);
                if (!bytes) throw UsageError("--max-size", "\"" + text + "\" is not 1M or more");
                options->page.max_bytes = *bytes;
            },
            "bound of the file, as 64M; beyond it pictures of slots are left out")
        .default_text("96M")
        .type_name("SIZE");
}

}  // namespace

void add_report(Command& app, Action& action) {
    Command command = app.add_command("report", "A run as an interactive HTML page");
    const auto options = std::make_shared<ReportArguments>();
    command.add_option("RUN", options->runs, "sample streams, or folders of them")
        .required()
        .input();
    command.add_option("-o,--output", options->output, "page")
        .shows_default()
        .type_name("FILE")
        .output(kPageName);
    command.add_option("--truth", options->truth, "footage that the sensor saw")
        .type_name("FOOTAGE")
        .input();
    add_footage_arguments(command, options->footage, "the truth");
    add_max_value(command, options->page.quality.max_value);
    command.add_option("--method", options->method, "decoding method beside naive")
        .shows_default()
        .one_of(names_of(decode_methods()))
        .type_name("NAME");
    command
        .add_option("--characterization", options->camera,
                    "figures of the sensor: what \"characterize --json\" wrote")
        .type_name("FILE")
        .input();
    command.add_option("--title", options->page.title, "heading of the page").type_name("TEXT");
    add_limits(command, options);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple report clip.stipple --truth scene -o clip.html\n"
        "  stipple report coded.stipple full4x.stipple --truth scene --method best\n"
        "  stipple report stipple_demo -o demo.html --crop 160x120+80+60\n"
        "The page needs no network and no other file.");
    set_action(command, action, options, make_report, [command, options] {
        if (options->truth.empty())
            command.refuse({"--transfer", "--raw", "--min-value", "--luminance"},
                           "is of --truth; add that or leave this out");
    });
}

}  // namespace stipple
