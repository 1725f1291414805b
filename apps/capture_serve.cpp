#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/arguments/served_source.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/serve/gige_server.h"
#include "core/version.h"

namespace stipple {
namespace {

struct ServeOptions {
    ServedSourceChoice source;
    GigeServerOptions server;
};

nlohmann::ordered_json counts_json(const GigeServerCounts& counts) {
    return {{"starts", counts.starts},
            {"frames", counts.frames},
            {"late_frames", counts.late_frames},
            {"packets", counts.packets},
            {"packets_resent", counts.packets_resent}};
}

std::string ready_text(const FrameSource& source, const GigeServerOptions& options) {
    const ServedImage& image = source.image();
    return fmt::format("READY gige:{} {} x {} {} at {:g} frames/s", options.address, image.width,
                       image.height, image.formats.front()->name, image.frames_hz);
}

std::string counts_text(const GigeServerCounts& counts) {
    return fmt::format("{} in {}, {} late; {}, {} sent again", counted(counts.frames, "frame"),
                       counted(counts.starts, "start"), counts.late_frames,
                       counted(counts.packets, "packet"), counts.packets_resent);
}

/// Reports on standard error the clients that take and give up control of the camera.
class ClientReport {
  public:
    explicit ClientReport(const GigeServer& server) : server_(&server) {}
    void look() {
        const std::string now = server_->client();
        if (now == client_) return;
        const std::uint64_t frames = server_->counts().frames;
        if (!client_.empty())
            say_note("{} has gone, {} sent", client_, counted(frames - frames_before_, "frame"));
        if (!now.empty()) say_note("{} controls the camera", now);
        client_ = now;
        frames_before_ = frames;
    }

  private:
    const GigeServer* server_;
    std::string client_;
    std::uint64_t frames_before_ = 0;
};

void serve(const ServeOptions& options, const RunOptions& run) {
    const auto source = open_served_source(options.source);
    GigeServerOptions settings = options.server;
    settings.model = source->image().coded_header.empty() ? "Recording" : "Coded sensor";
    settings.version = version();
    JsonFile json(run);
    GigeServer server(*source, settings);
    print_text(ready_text(*source, settings) + "\n");
    flush_output();  // who waits for it finds the camera
    ClientReport clients(server);
    std::string said;
    server.run([&] {
        if (const std::string warning = source->warning(); warning != said)
            say_warning(said = warning);
        if (!run.quiet) clients.look();
        return stop_signal() != 0;
    });
    json.write(counts_json(server.counts()));
    run.say(counts_text(server.counts()));
    throw_if_stopped();  // there is no output that could be shorter
}

/// `--fault-...` and `--no-resend`: simulated faults, for tests of clients.
void add_fault_arguments(Command& command, GigeServerOptions& options) {
    constexpr auto kGroup = "Faults, for tests of clients";
    GvspFaults& faults = options.faults;
    const auto share = [&](const std::string& name, double& value, const std::string& what) {
        command.add_option(name, value, what)
            .shows_default()
            .check(number_check(0, 1))
            .type_name("SHARE")
            .group(kGroup);
    };
    const auto count = [&](const std::string& name, auto& value, const std::string& what) {
        return command.add_option(name, value, what).type_name("N").group(kGroup);
    };
    share("--fault-drop", faults.drop, "share of packets that are only sent on request");
    share("--fault-lose", faults.lose, "share of packets that are never sent");
    share("--fault-duplicate", faults.duplicate, "share of packets that are sent twice");
    command.add_flag("--fault-reorder", faults.reorder, "swap every fourth packet with the next")
        .group(kGroup);
    auto gap_at = count("--fault-gap-at", faults.gap_at, "frame before which ids are skipped");
    auto gap = count("--fault-gap", faults.gap_frames, "number of ids skipped there");
    gap_at.needs(gap);
    gap.needs(gap_at);
    count("--fault-first-block", faults.first_block, "block id of the first frame")
        .shows_default()
        .check(whole_check(1, 65535));
    count("--fault-begin-at", faults.begin_at, "frame before which nothing is sent");
    count("--fault-freeze-at", faults.freeze_at, "frame from which on nothing is sent");
    count("--fault-seed", faults.seed, "seed of the draw of the packets").shows_default();
    command
        .add_flag(
            "--no-resend", [&options] { options.can_resend = false; },
            "do not send packets again on request")
        .group(kGroup);
}

/// GigE Vision 2.0, 27.17: 16 bytes, the last of which is 0.
std::string check_serial(const std::string& serial) {
    constexpr std::size_t kMaxBytes = 15;
    if (!serial.empty() && serial.size() <= kMaxBytes) return {};
    return fmt::format("has {} bytes; GigE Vision has room for 1 to {}", serial.size(), kMaxBytes);
}

void check_mode(const Command& command, const ServedSourceChoice& source) {
    if (source.mode == ServedMode::kCoded)
        command.refuse({"--format"}, "needs --mode frames; leave it out");
    else
        command.refuse({"--sensor", "--schedule", "--set", "--seed", "--overrun", "--threads"},
                       "needs --mode coded; add it, or leave this out");
}

void check_faults(const Command& command, const GvspFaults& faults) {
    if (faults.drop + faults.lose + faults.duplicate > 0) return;
    command.refuse({"--fault-seed"},
                   "no packet is hit; add --fault-drop, --fault-lose or --fault-duplicate");
}

}  // namespace

void add_capture_serve(Command& capture, Action& action) {
    Command command = capture.add_command("serve", "Frames or a coded stream as a GigE camera");
    const auto options = std::make_shared<ServeOptions>();
    add_served_source(command, options->source);
    command.add_option("--address", options->server.address, "IPv4 address of this machine")
        .shows_default()
        .type_name("IP");
    command.add_option("--serial", options->server.serial, "serial number, 1 to 15 bytes")
        .default_text("the address")
        .check(check_serial)
        .type_name("TEXT");
    command.add_flag("--repeat", options->server.repeat, "begin again at the end of the source");
    command.add_flag("--allow-other-destination", options->server.allow_other_destination,
                     "let a client send the frames to another address than its own");
    add_fault_arguments(command, options->server);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple capture serve video.mp4 --luminance --format Mono12p --frames-hz 200 --repeat\n"
        "  stipple capture serve scene --mode coded --address 127.0.0.2");
    set_action(command, action, options, serve, [command, options] {
        check_mode(command, options->source);
        check_faults(command, options->server.faults);
    });
}

}  // namespace stipple
