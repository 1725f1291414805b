#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/output_names.h"
#include "study/report/camera_file.h"
#include "study/report/run_report.h"
#include "study/report/stream_report.h"

namespace stipple {
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

ReportTruth truth_of(const std::string& file, ReadAhead& footage) {
    return {.name = file, .shape = footage.shape(), .bytes = input_bytes(file), .next = [&footage] {
                return footage.next();
            }};
}

void make_report(const ReportArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    StreamReportTask task{.runs = arguments.runs,
                          .output = arguments.output,
                          .force = run.force,
                          .methods = {decode_method_from_name(arguments.method)},
                          .page = arguments.page};
    task.page.command = own_command();
    std::optional<ReadAhead> footage;
    if (!arguments.truth.empty()) {
        footage.emplace(arguments.truth, arguments.footage,
                        [](const Message& warning) { say_warning(warning); });
        task.truth = truth_of(arguments.truth, *footage);
    }
    if (!arguments.camera.empty()) task.camera = read_camera_file(arguments.camera);
    std::optional<Progress> progress;
    const StreamReportResult made =
        report_streams(std::move(task), {.check = [] { throw_if_stopped(); },
                                         .begin =
                                             [&](const std::string& what, std::int64_t slots) {
                                                 progress.emplace(run, what, slots);
                                                 return [&](double done) {
                                                     progress->reach(done);
                                                     return stop_signal() == 0;
                                                 };
                                             }});
    progress.reset();
    for (const std::string& note : made.notes) say_warning(note);
    say_warning(chart_warning());
    json.write(nlohmann::ordered_json::parse(made.figures));
    run.say(fmt::format("{}: {} of {}, {:.1f} MB", arguments.output, counted(made.videos, "video"),
                        counted(made.runs, "run"), 1e-6 * static_cast<double>(made.bytes)));
    if (!made.damage.empty())
        throw InputError(arguments.output,
                         "shows only the undamaged part of damaged streams: " + made.damage);
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
