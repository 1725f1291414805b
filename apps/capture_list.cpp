#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "capture/camera_search.h"

namespace stipple {
namespace {

nlohmann::ordered_json search_json(const CameraSearch& search) {
    nlohmann::ordered_json json{{"cameras", nlohmann::ordered_json::array()},
                                {"problems", search.problems}};
    for (const CameraListing& camera : search.cameras)
        json["cameras"].push_back({{"address", camera.address},
                                   {"transport", camera.transport},
                                   {"vendor", camera.vendor},
                                   {"model", camera.model},
                                   {"serial", camera.serial}});
    return json;
}

std::string search_text(const CameraSearch& search) {
    std::string text = search.cameras.empty() ? "no camera found" : "";
    for (const CameraListing& camera : search.cameras)
        text += fmt::format("{}{:<28} {:<12} {} {} {}", text.empty() ? "" : "\n", camera.address,
                            camera.transport, camera.vendor, camera.model, camera.serial);
    for (const std::string& problem : search.problems) text += fmt::format("\n{}", problem);
    return text;
}

void list(const RunOptions& run) {
    JsonFile json(run);
    const CameraSearch search = [] {
        const SignalBlocker a_second;
        return list_cameras();
    }();
    throw_if_stopped();
    json.write(search_json(search));
    run.say(search_text(search));
}

}  // namespace

void add_capture_list(Command& capture, Action& action) {
    Command command = capture.add_command("list", "Cameras that can be opened, with addresses");
    command.footer(
        "Example:\n"
        "  stipple capture list");
    command.callback([&action] { action.run = list; });
}

}  // namespace stipple
