#include "apps/live_emulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>

#include "apps/footage_origin.h"
#include "apps/interrupt.h"
#include "apps/report/emulation_text.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/rate_warning.h"
#include "apps/report/session_report.h"
#include "apps/report/standard_error.h"
#include "capture/host_clock.h"
#include "capture/recording/replay_camera.h"
#include "core/error.h"
#include "core/gap_limit.h"

namespace stipple {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollInterval{50};
constexpr double kRateAfterS = 1;
constexpr std::size_t kMaxLateListed = 1000;

/// A random number: packets of two recordings with the same settings are told apart by it
/// (docs/stream_format.md, "Packet").
std::string new_recording_name() {
    std::random_device random;
    return fmt::format("{:08x}{:08x}", random(), random());
}

/// What the stream says of where its light came from: no address, no time.
FootageOrigin origin_of(const LiveArguments& arguments, const CameraDescription& camera) {
    FootageOrigin origin{.name = camera.model};
    if (is_replay(arguments.camera)) {
        origin = origin_of(std::string(replayed_file(arguments.camera.address)), FootageOptions{});
    } else {
        origin.recording = new_recording_name();
    }
    origin.black_level_dn = arguments.black_level_dn;
    return origin;
}

void say_event(const SessionEvent& event) {
    if (const auto* const outage = std::get_if<Outage>(&event)) say(*outage);
    if (const auto* const recovery = std::get_if<Recovery>(&event)) say(*recovery);
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) say_warning(lost->warning);
}

}  // namespace

LiveEmulation::LiveEmulation(const LiveArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      camera_(
          [camera = arguments.camera, settings = camera_settings(arguments.camera)] {
              return open_picture_camera(camera, settings);
          },
          {.session = session_options(arguments.camera, arguments.session),
           .waiting_frames = arguments.queue_frames,
           .from_start = is_replay(arguments.camera),
           .tell = say_event}),
      to_light_(camera_.layout(), arguments.black_level_dn),
      setup_(set_up_sensor(arguments.sensor, to_light_.shape(), to_light_.filter())),
      recorder_(arguments.output, run.force, setup_,
                provenance_of(setup_, origin_of(arguments, camera_.description()))),
      light_(to_light_.shape().sites()) {
    say_leftover(arguments.output);
    say_warnings(camera_.description());
    say_warning(mosaic_warning(setup_, to_light_.filter()));
    // Threads and code are in place before the first frame comes.
    static_cast<void>(Emulator(setup_).expose(light_));
    if (!arguments.preview.file.empty())
        preview_.emplace(
            arguments.preview.file,
            PreviewDecoder(stream_header_of(setup_, {}), preview_options(arguments.preview)));
}

bool LiveEmulation::wants_more(double seconds) const {
    return !end_ && stop_signal() == 0 && !arguments_.limits.reached(latencies_.count(), seconds);
}

void LiveEmulation::run(const RunOptions& run) {
    Progress progress(run, "emulating live", arguments_.limits.total());
    camera_.begin();
    try {
        while (wants_more(progress.seconds())) {
            if (const auto frame = camera_.next(kPollInterval))
                take(*frame);
            else
                end_ = camera_.end();
            progress.reach(static_cast<double>(latencies_.count()));
            if (held_slots_ + late_slots_ > 0)
                progress.note(fmt::format("{} held, {} late", held_slots_, late_slots_));
        }
    } catch (...) {  // the disk, or no memory: `finish` keeps what was written
        failure_ = std::current_exception();
    }
}

/// As many of the slots before a frame as are in proportion to the frames: what a camera or a clock
/// says of them has no limit.
std::uint64_t LiveEmulation::lost_to_hold(std::uint64_t lost) {
    const auto frames = static_cast<std::int64_t>(latencies_.count()) + 1;
    const auto most = static_cast<std::uint64_t>(max_missing_slots(frames, to_light_.shape()));
    const std::uint64_t held = std::min(lost, most - std::min(most, held_slots_));
    if (held < lost && unheld_slots_ == 0)
        say_warning(fmt::format(
            "{}: {} are missing before a frame, too many beside those that came: the frame before "
            "stands in for {} of them, so slots from {} on come too early",
            arguments_.camera.address, counted(lost, "frame"), held,
            recorder_.stats().slots + static_cast<std::int64_t>(held)));
    unheld_slots_ += lost - held;
    return held;
}

void LiveEmulation::hold_missing(const FrameRecord& record) {
    if (latencies_.count() == 0) return;  // nothing stands in for what came before the first frame
    const std::uint64_t incomplete = record.status == FrameStatus::kComplete ? 0 : 1;
    const std::uint64_t slots = lost_to_hold(record.lost_before) + incomplete;
    for (std::uint64_t slot = 0; slot < slots; ++slot) expose(monotonic_ns());
    held_slots_ += slots;
    totals_.lost[static_cast<std::size_t>(record.cause)] += record.lost_before;
    totals_.incomplete += incomplete;
}

void LiveEmulation::expose(std::int64_t arrival_ns) {
    const auto packets = recorder_.expose(light_);
    if (preview_) preview_->add(packets, arrival_ns);
}

void LiveEmulation::take(const CapturedFrame& frame) {
    if (frame.record.layout != camera_.layout()) {
        end_ = DeviceLost{"the camera sends another region or pixel format"};
        return;
    }
    hold_missing(frame.record);
    rate_.add(frame.record);
    if (rate_.seconds() >= kRateAfterS) compare_rates();
    if (frame.record.status != FrameStatus::kComplete) return;
    to_light_.convert(frame.payload, light_);
    expose(frame.record.host_monotonic_ns);
    last_done_ns_ = monotonic_ns();
    if (latencies_.count() == 0) first_done_ns_ = last_done_ns_;
    const auto latency_us =
        static_cast<double>(last_done_ns_ - frame.record.host_monotonic_ns) * 1e-3;
    latencies_.add(latency_us);
    if (latency_us <= arguments_.late_after_slots * setup_.params.slot_us) return;
    ++late_slots_;
    if (late_.size() < kMaxLateListed)
        late_.push_back({recorder_.stats().slots - 1, frame.record.host_monotonic_ns, latency_us});
}

void LiveEmulation::compare_rates() {
    if (!std::exchange(rates_compared_, true))
        say_warning(camera_rate_warning(rate_, setup_.params));
}

std::optional<double> LiveEmulation::slots_per_s() const {
    const auto passed_s = static_cast<double>(last_done_ns_ - first_done_ns_) * 1e-9;
    if (passed_s <= 0) return std::nullopt;  // of a single slot
    return static_cast<double>(recorder_.stats().slots - 1) / passed_s;
}

void LiveEmulation::put_in_place() {
    try {
        if (!failure_) return recorder_.finish();
    } catch (...) {
        failure_ = std::current_exception();
    }
    if (!recorder_.keep()) return;  // the message of the failure says where it is
    say_kept(arguments_.output.c_str());
}

void LiveEmulation::finish() {
    totals_.repeated = camera_.stop().repeated;
    if (latencies_.count() == 0) {
        throw_if_stopped();
        if (failure_) std::rethrow_exception(failure_);
        if (end_ && end_->bad_file) throw InputError(*end_->bad_file);
        throw DeviceError(arguments_.camera.address, end_ ? end_->reason : "no frame came");
    }
    compare_rates();
    put_in_place();
    if (preview_) preview_->finish();
    if (failure_) std::rethrow_exception(failure_);
    if (end_ && end_->bad_file) {
        say_kept(arguments_.output.c_str());
        throw InputError(*end_->bad_file);
    }
    if (end_ && !end_->at_end) throw DeviceError(arguments_.camera.address, end_->reason);
}

nlohmann::ordered_json LiveEmulation::json() const {
    nlohmann::ordered_json json = emulation_json(recorder_, slots_per_s());
    json["frames"] = latencies_.count();
    json["frames_hz"] = rate_.hz() ? nlohmann::ordered_json(*rate_.hz()) : nullptr;
    json["slots_hz"] = 1e6 / setup_.params.slot_us;
    json["incomplete"] = totals_.incomplete;
    json["repeated"] = totals_.repeated;
    json["lost"] = lost_json(totals_);
    json["transport"] = transport_json(camera_.transport());
    json["held_slots"] = held_slots_;
    json["unheld_slots"] = unheld_slots_;
    json["late_slots"] = late_slots_;
    json["late"] = nlohmann::ordered_json::array();
    for (const LateSlot& late : late_)
        json["late"].push_back({{"slot", late.slot},
                                {"arrival_monotonic_ns", late.arrival_ns},
                                {"latency_us", late.latency_us}});
    json["queue_peak_frames"] = camera_.peak();
    json["latency_us"] = {{"median", latencies_.quantile_us(0.5)},
                          {"p99", latencies_.quantile_us(0.99)},
                          {"max", latencies_.longest_us()}};
    if (preview_) json["preview"] = preview_->json();
    return json;
}

std::string LiveEmulation::text() const {
    std::string text = fmt::format(
        "{}: {}\n{}, {} late (more than {} slots), {} held for frames that are missing or "
        "incomplete{}\n"
        "lost: {}; incomplete: {}\n"
        "frame in to packet out: median {:.2f} ms, 99 % within {:.2f} ms, all within {:.2f} ms",
        arguments_.output, emulation_text(recorder_, slots_per_s()),
        counted(latencies_.count(), "frame"), counted(late_slots_, "slot"),
        arguments_.late_after_slots, held_slots_,
        unheld_slots_ == 0 ? "" : fmt::format(", {} left out", unheld_slots_), lost_text(totals_),
        totals_.incomplete, latencies_.quantile_us(0.5) * 1e-3, latencies_.quantile_us(0.99) * 1e-3,
        latencies_.longest_us() * 1e-3);
    if (preview_) text.append(1, '\n').append(preview_->text());
    return text;
}

}  // namespace stipple
