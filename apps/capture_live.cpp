#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "apps/arguments/camera.h"
#include "apps/arguments/common_options.h"
#include "apps/arguments/page_server.h"
#include "apps/arguments/preview.h"
#include "apps/arguments/sensor.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/output/preview_image.h"
#include "apps/output/progress.h"
#include "apps/output/session_report.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/stream_output.h"
#include "apps/subcommands.h"
#include "capture/capture_end.h"
#include "capture/live_emulator.h"
#include "capture/open_camera.h"
#include "capture/sensor_warnings.h"
#include "io/disk_sync.h"
#include "io/output_names.h"
#include "readout/emulator.h"
#include "readout/sensor_file.h"
#include "view/live_view.h"
#include "view/view_page.h"

namespace stipple {
namespace {

struct LiveArguments {
    CameraArguments camera;
    SessionOptions session{.incomplete = IncompletePolicy::kKeep};  ///< they are held, and counted
    SensorChoice sensor;
    std::string output;
    double black_level_dn = 0;
    CaptureLimits limits;
    PreviewArguments preview;
    std::size_t queue_frames = 64;
    double late_after_slots = 2;
    bool view = false;
    PageServerOptions server;
    bool fails_on_loss = false;
};

LiveCameraOptions camera_options(const LiveArguments& arguments) {
    return {.session = session_options(arguments.camera.address, arguments.session),
            .waiting_frames = arguments.queue_frames,
            .from_start = is_replay(arguments.camera),
            .tell = say_event};
}

/// A page on the stream while it is written. Null without --view.
struct LivePage {
    LivePage(const LiveCamera& camera, const LiveArguments& arguments, const SensorSetup& setup,
             ColourFilter mosaic)
        : sensor(arguments.sensor, setup, mosaic,
                 arguments.preview.file.empty() ? "" : "its preview shows one schedule"),
          live(camera, arguments.black_level_dn, setup, sensor, arguments.output),
          page({.sources = {}, .camera = &live, .command = own_command()}),
          server(arguments.server,
                 [this](const PageRequest& request) { return page.answer(request); }) {
        say_note("the page of the camera: {}", server.url());
    }
    ~LivePage() {
        sensor.end();
        page.end();
    }

    ViewedSensor sensor;
    LiveView live;
    ViewPage page;
    PageServer server;
};

LiveEmulation emulate(LiveEmulator& emulator, const SensorParams& sensor,
                      std::optional<std::int64_t> frames, LivePage* page, const RunOptions& run) {
    constexpr double kRateAfterS = 1;
    Progress progress(run, "emulating live", frames);
    bool rate_compared = false;
    bool drops_told = false;
    LiveEmulation result = emulator.run([&](const LiveEmulation& now) {
        if (now.rate.seconds() >= kRateAfterS && !std::exchange(rate_compared, true))
            say_warning(camera_rate_warning(now.rate, sensor));
        if (now.dropped_slots > 0 && !std::exchange(drops_told, true))
            say_warning(
                "the emulation is slower than the camera: frames that find the queue full are "
                "dropped, and their slots have no samples");
        if (page != nullptr) page->live.note(now);
        progress.reach(static_cast<double>(now.latencies.count()));
        if (now.held_slots + now.late_slots > 0)
            progress.note(fmt::format("{} held, {} dropped, {} late",
                                      now.held_slots - now.dropped_slots, now.dropped_slots,
                                      now.late_slots));
        return stop_signal() == 0;
    });
    if (!rate_compared && result.latencies.count() > 0)
        say_warning(camera_rate_warning(result.rate, sensor));
    return result;
}

LivePreviewOptions show_in(const std::string& file) {
    return {.show =
                [file](const PreviewFrame& frame) {
                    const NoSync no_sync;  // the next image comes soon
                    write_preview(file, frame);
                },
            .tell =
                [](const Message& failure) {
                    say_warning("no preview: " + failure + "; the recording goes on");
                },
            .keep_going = [] { return stop_signal() == 0; }};
}

void say_slow_preview() {
    say_note(
        "the recording is complete; its preview ends slowly, as the machine is busy. Ctrl-C twice "
        "does not wait");
}

/// Null without --preview.
std::unique_ptr<LivePreview> open_preview(const PreviewArguments& arguments,
                                          const SensorSetup& setup) {
    if (arguments.file.empty()) return nullptr;
    return std::make_unique<LivePreview>(stream_header_of(setup, {}), preview_options(arguments),
                                         show_in(arguments.file));
}

LiveEmulatorOptions emulator_options(const LiveArguments& arguments, LivePreview* preview,
                                     LivePage* page) {
    LiveEmulatorOptions options{
        .limits = arguments.limits,
        .late_after_slots = arguments.late_after_slots,
        .tell = [&address = arguments.camera.address](const LeftOut& left_out) {
            say_warning(left_out_text(address, left_out));
        }};
    options.show = [preview, page](const LiveSlot& slot) {
        if (preview != nullptr) preview->add(slot.packets, slot.arrival_ns);
        if (page != nullptr) page->live.recent().add(slot.payload, slot.packets, slot.arrival_ns);
    };
    if (page != nullptr)
        options.before_slot = [page](StreamRecorder& recorder) {
            page->live.switch_sensor(recorder);
        };
    return options;
}

/// Writes the figures and says the result.
void tell(const LiveReport& report, const LiveArguments& arguments, const LivePreview* preview,
          JsonFile& json, const RunOptions& run) {
    auto figures = live_json(report);
    std::string text = live_text(report, arguments.output, arguments.late_after_slots);
    if (preview != nullptr) {
        figures["preview"] = preview_json(arguments.preview.file, *preview);
        text += "\n" + preview_text(arguments.preview.file, *preview);
    }
    json.write(figures);
    run.say(text);
}

void live(const LiveArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    if (!arguments.preview.file.empty()) check_preview_file(arguments.preview, run.force);
    LiveCamera camera(image_camera_opener(arguments.camera), camera_options(arguments));
    const FrameLight to_light(camera.layout(), arguments.black_level_dn);
    const SensorSetup setup = set_up_sensor(arguments.sensor, to_light.shape(), to_light.filter());
    const std::string& address = arguments.camera.address;
    const FootageOrigin origin =
        live_origin(address, camera, arguments.black_level_dn, [] { throw_if_stopped(); });
    const bool may_switch = arguments.view && no_switch_text(setup).empty();
    StreamRecorder recorder =
        open_stream_output(arguments.output, run, setup, origin,
                           may_switch ? std::optional(Switches{}) : std::nullopt);
    say_warnings(camera.description());
    say_warning(mosaic_warning(setup, to_light.filter()));
    const auto preview = open_preview(arguments.preview, setup);
    const auto page = arguments.view
                          ? std::make_unique<LivePage>(camera, arguments, setup, to_light.filter())
                          : nullptr;
    LiveEmulator emulator(camera, to_light, recorder,
                          emulator_options(arguments, preview.get(), page.get()));
    LiveEmulation emulation =
        emulate(emulator, setup.params, arguments.limits.total(), page.get(), run);
    emulation.totals.repeated = camera.stop().repeated;
    if (emulation.latencies.count() == 0) {
        throw_if_stopped();
        throw_early_end(emulation, address);
    }
    if (commit_recording(recorder, emulation)) report_kept(arguments.output.c_str());
    if (preview) preview->finish(say_slow_preview);
    const auto& end = emulation.end;
    if (!emulation.failure && end && (end->bad_file || !end->at_end))
        report_kept(arguments.output.c_str());
    throw_early_end(emulation, address);
    tell({emulation, recorder, camera}, arguments, preview.get(), json, run);
    if (arguments.fails_on_loss) throw_if_lost(losses_text(emulation.totals), arguments.output);
}

}  // namespace

void add_capture_live(Command& capture, Action& action) {
    Command command = capture.add_command("live", "A camera through the sensor as it runs");
    const auto options = std::make_shared<LiveArguments>();
    add_camera_arguments(command, options->camera);
    add_output(command, options->output, "sample stream", kStreamName);
    add_capture_limits(command, options->limits);
    add_sensor_arguments(command, options->sensor);
    auto sections = sensor_sections(options->sensor);
    sections.push_back({"camera", &options->camera.settings});
    add_settings(command, std::move(sections),
                 "change a key of the sensor or of the schedule, or set a feature of the camera");
    add_preview_arguments(command, options->preview);
    command.add_flag("--view", options->view,
                     "show frames, samples and decoded video in a browser (docs/view.md)");
    add_page_server_options(command, options->server);
    add_session_arguments(command, options->session);
    add_loss_argument(command, options->fails_on_loss);
    command.add_option("--black-level", options->black_level_dn, "DN without light")
        .shows_default()
        .check(number_check(0))
        .type_name("DN");
    command
        .add_option("--queue", options->queue_frames,
                    "frames that may wait for the emulator; further frames are dropped and counted")
        .shows_default()
        .check(whole_check(1, LiveCameraOptions::kMaxWaitingFrames))
        .type_name("N");
    command
        .add_option("--late-after", options->late_after_slots,
                    "a slot is late if its packet is written more than N slots after its frame")
        .shows_default()
        .check(positive_check())
        .type_name("N");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple capture live gige:192.168.0.5 -o clip.stipple --seconds 10\n"
        "  stipple capture live v4l2:/dev/video0 -o clip.stipple --preview now.png\n"
        "  stipple capture live replay:clip.strec -o clip.stipple --schedule tiled");
    set_action(command, action, options, live, [command, options] {
        if (options->preview.file.empty())
            command.refuse({"--preview-method", "--preview-size"},
                           "there is no preview; add --preview FILE or leave it out");
        if (!options->view)
            command.refuse({"--port", "--address"}, "there is no page; add --view or leave it out");
        check_session_arguments(command, options->camera);
    });
}

}  // namespace stipple
