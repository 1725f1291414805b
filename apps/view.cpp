#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/camera_kind.h"
#include "core/error.h"
#include "decoder/decode_method.h"
#include "session/rig_folder.h"
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
    PageServerOptions server;
    bool open = false;
};

/// \throws InputError for what a page does not show yet.
void check_source(const std::string& source) {
    const auto is_of = [&](const CameraKind& kind) {
        return source.starts_with(std::string(kind.prefix) + ":") && !kind.is_replay;
    };
    if (std::ranges::any_of(camera_kinds(), is_of))
        throw InputError(source,
                         "a page shows files; write the camera's stream with \"stipple capture "
                         "live\", and view that file while it grows");
    if (is_rig_folder(source))
        throw InputError(source, "is a rig; a page shows its streams, or its decoded video");
}

ViewOptions view_options(const ViewArguments& arguments) {
    ViewOptions options{.sources = {},
                        .truth = arguments.truth,
                        .footage = arguments.footage,
                        .decoding = read_decode_setup(arguments.method, Config({})),
                        .calibration = calibration_choice(arguments.calibration),
                        .command = own_command(),
                        .warn = [](const Message& warning) { say_warning(warning); }};
    for (const std::string& source : arguments.sources) {
        check_source(source);
        options.sources.emplace_back(source);
    }
    return options;
}

/// Shows a page in the browser that the user has chosen for the desktop.
void open_browser(std::string url) {
    std::string program = "xdg-open";
    const std::array<char*, 3> arguments{program.data(), url.data(), nullptr};
    pid_t process = 0;
    if (posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
        say_warning("xdg-open (package xdg-utils) is not there; open the address in a browser");
}

void view(const ViewArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    ViewPage page(view_options(arguments));
    const PageServer server(arguments.server,
                            [&](const PageRequest& request) { return page.answer(request); });
    json.write({{"url", server.url()},
                {"slots", page.slots()},
                {"rows", page.shape().rows},
                {"cols", page.shape().cols},
                {"planes", page.shape().planes}});
    run.say(fmt::format("{}\nOpen this address in a browser. Ctrl-C ends the page.", server.url()));
    if (std::fflush(stdout) != 0)  // a page whose address nobody sees
        throw std::system_error(errno, std::generic_category(), "standard output");
    if (arguments.open) open_browser(server.url());
    while (stop_signal() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    page.end();
    throw_if_stopped();
}

void add_server_options(Command& command, const std::shared_ptr<ViewArguments>& options) {
    command.add_option("--port", options->server.port, "TCP port of the page")
        .default_text("a free one")
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--address", options->server.address,
                    "address of the network interface; 0.0.0.0 serves every network, unencrypted")
        .shows_default()
        .type_name("IP");
    command.add_flag("--open", options->open, "show the page in the browser of the desktop");
}

}  // namespace

void add_view(Command& app, Action& action) {
    Command command =
        app.add_command("view", "Streams and videos in the browser, any slot at once");
    const auto options = std::make_shared<ViewArguments>();
    command
        .add_option("SOURCE", options->sources,
                    "sample streams, whole or growing; footage, decoded videos, recordings")
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
    add_server_options(command, options);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple view clip.stipple --truth scene --open\n"
        "  stipple view live.stipple --method fast\n"
        "The address has a random token; who does not know it sees nothing.");
    set_action(command, action, options, view);
}

}  // namespace stipple
