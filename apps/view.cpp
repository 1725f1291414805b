#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "apps/arguments/camera.h"
#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/arguments/page_server.h"
#include "apps/arguments/sensor.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/output/session_report.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/camera_kind.h"
#include "capture/open_camera.h"
#include "core/error.h"
#include "core/input_file.h"
#include "decoder/decode_method.h"
#include "session/rig_folder.h"
#include "view/camera_page.h"
#include "view/page_server.h"
#include "view/view_page.h"

namespace stipple {
namespace {

struct ViewArguments {
    std::vector<std::string> sources;
    std::string truth;  ///< empty: none
    std::string method = "best";
    std::string calibration;  ///< as calibration_choice
    FootageOptions footage;
    CameraArguments camera;  ///< but its address
    SensorChoice sensor;     ///< that is emulated
    double black_level_dn = 0;
    std::string folder = ".";  ///< of recordings
    PageServerOptions server;
    bool open = false;
};

bool is_running_camera(const std::string& source) {
    return std::ranges::any_of(camera_kinds(), [&](const CameraKind& kind) {
        return source.starts_with(std::string(kind.prefix) + ":") && !kind.is_replay;
    });
}

bool is_results_folder(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path / "table.csv", error);
}

/// \throws InputError for what a page does not show.
void check_source(const std::string& source) {
    if (is_running_camera(source))
        throw InputError(source, "a running camera has a page of its own; leave the others out");
    if (is_results_folder(source))
        throw InputError(source,
                         "results of explore have a page of their own; leave the others out");
}

/// The streams of a rig, or what is no rig itself.
std::vector<std::filesystem::path> files_of(const std::string& source) {
    if (!is_rig_folder(source)) return {source};
    std::vector<std::filesystem::path> files;
    for (const StreamReader& reader : open_rig_folder(source, ReadPolicy::kTolerant).readers)
        files.emplace_back(reader.name());
    return files;
}

/// The page that `explore` has written into its folder of results, and may write again.
struct ResultsPage {
    std::filesystem::path file;

    /// \throws InputError without a page.
    explicit ResultsPage(const std::filesystem::path& folder) : file(folder / "report.html") {
        if (!std::filesystem::exists(file))
            throw InputError(folder.string(),
                             "has results of explore without their page; run it again without " +
                                 Parameter{"no-report"});
    }
    [[nodiscard]] std::optional<PageAnswer> answer(const PageRequest& request) const {
        if (!request.path.empty() || request.acts) return {};
        const auto bytes = read_file(file);
        return PageAnswer{"text/html; charset=utf-8", {bytes.begin(), bytes.end()}};
    }
    void end() const {}
};

ViewedCameraOptions camera_options(const ViewArguments& arguments) {
    const std::string& address = arguments.sources.front();
    return {
        .address = address,
        .open =
            [address, buffers = arguments.camera.buffers](const CameraSettings& settings) {
                return interruptible([=] { return open_image_camera(address, settings, buffers); });
            },
        .settings = camera_settings(arguments.camera),
        .sensor = arguments.sensor,
        .black_level_dn = arguments.black_level_dn,
        .folder = arguments.folder,
        .tell = say_event,
        .warn = [](const Message& warning) { say_warning(warning); }};
}

/// Without sources.
ViewOptions view_options(const ViewArguments& arguments) {
    return ViewOptions{.sources = {},
                       .truth = arguments.truth,
                       .footage = arguments.footage,
                       .decoding = read_decode_setup(arguments.method, Config({})),
                       .calibration = calibration_choice(arguments.calibration),
                       .command = own_command(),
                       .warn = [](const Message& warning) { say_warning(warning); }};
}

/// Shows a page in the browser that the user has chosen for the desktop.
void open_browser(std::string url) {
    std::string program = "xdg-open";
    const std::array<char*, 3> arguments{program.data(), url.data(), nullptr};
    pid_t process = 0;
    if (posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
        say_warning("xdg-open (package xdg-utils) is not there; open the address in a browser");
}

/// Serves a page with these figures until a signal comes.
template <typename Page>
void serve(Page& page, nlohmann::ordered_json figures, const ViewArguments& arguments,
           JsonFile& json, const RunOptions& run) {
    const PageServer server(arguments.server,
                            [&](const PageRequest& request) { return page.answer(request); });
    figures["url"] = server.url();
    json.write(figures);
    run.say(fmt::format("{}\nOpen this address in a browser. Ctrl-C ends the page.", server.url()));
    flush_output();  // or nobody sees the address
    if (arguments.open) open_browser(server.url());
    while (stop_signal() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    page.end();
    throw_if_stopped();
}

template <typename Page>
nlohmann::ordered_json figures_of(Page& page) {
    const FrameShape shape = page.shape();
    return {{"slots", page.slots()},
            {"rows", shape.rows},
            {"cols", shape.cols},
            {"planes", shape.planes}};
}

void view(const ViewArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    const std::string& first = arguments.sources.front();
    if (arguments.sources.size() == 1 && is_running_camera(first)) {
        CameraPage page(camera_options(arguments), view_options(arguments));
        return serve(page, figures_of(page), arguments, json, run);
    }
    if (arguments.sources.size() == 1 && is_results_folder(first)) {
        const ResultsPage page{first};
        return serve(page, {}, arguments, json, run);
    }
    ViewOptions options = view_options(arguments);
    for (const std::string& source : arguments.sources) {
        check_source(source);
        for (const auto& file : files_of(source)) options.sources.push_back(file);
    }
    ViewPage page(options);
    serve(page, figures_of(page), arguments, json, run);
}

void add_running_camera_options(Command& command, ViewArguments& options) {
    add_camera_options(command, options.camera);
    add_sensor_arguments(command, options.sensor);
    auto sections = sensor_sections(options.sensor);
    sections.push_back({"camera", &options.camera.settings});
    add_settings(command, std::move(sections),
                 "of a running camera: set one of its features, or change a key of the sensor or "
                 "of the schedule that are emulated");
    command.add_option("--black-level", options.black_level_dn, "DN without light")
        .shows_default()
        .check(number_check(0))
        .type_name("DN");
    command.add_option("--recordings", options.folder, "folder of recordings of the camera")
        .default_text("the current one")
        .type_name("DIR");
}

}  // namespace

void add_view(Command& app, Action& action) {
    Command command =
        app.add_command("view", "Streams and videos in the browser, any slot at once");
    const auto options = std::make_shared<ViewArguments>();
    command
        .add_option(
            "SOURCE", options->sources,
            "sample streams, whole or growing; rigs, footage, decoded videos, recordings; or "
            "a running camera; or results of explore")
        .required()
        .input();
    command.add_option("--truth", options->truth, "footage that the sensor saw")
        .type_name("FOOTAGE")
        .input();
    command.add_option("--method", options->method, "decoding method of the last pictures")
        .shows_default()
        .one_of(names_of(decode_methods()))
        .type_name("NAME");
    command
        .add_option("--calibration", options->calibration,
                    "calibration of the chip, or \"none\"; default: the file beside the stream")
        .type_name("FILE");
    add_footage_arguments(command, options->footage);
    add_running_camera_options(command, *options);
    add_page_server_options(command, options->server);
    command.add_flag("--open", options->open, "show the page in the browser of the desktop");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple view clip.stipple --truth scene --open\n"
        "  stipple view live.stipple --method fast\n"
        "  stipple view gige:192.168.0.5 --sensor lux2100 --set camera.ExposureTime=2000\n"
        "The address has a random token; who does not know it sees nothing.");
    set_action(command, action, options, view, [command, options] {
        if (std::ranges::none_of(options->sources, is_running_camera))
            command.refuse({"--config", "--buffers", "--sensor", "--schedule", "--seed",
                            "--overrun", "--set", "--black-level", "--recordings"},
                           "there is no running camera; leave it out");
    });
}

}  // namespace stipple
