#include "view/viewed_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "capture/capture_figures.h"
#include "capture/recording/frame_recording.h"
#include "core/error.h"
#include "core/message.h"
#include "stream/schedule_switch.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

constexpr std::chrono::milliseconds kPollInterval{20};
constexpr std::size_t kWaitingFrames = 16;  ///< for the emulation
constexpr std::size_t kRecordingBytes = std::size_t{1} << 28U;

std::string loss_text(const FrameRecord& record) {
    std::string cause(name_in(kGapCauses, record.cause));
    std::ranges::replace(cause, '_', ' ');
    return fmt::format("{} lost before frame {}: {}", record.lost_before, record.id, cause);
}

}  // namespace

/// A recording, and what the session had counted when it began.
struct ViewedCamera::Recording {
    Recording(const std::filesystem::path& file, const SessionRecord& session)
        : output(file, false), frames(output, session, {.bytes = kRecordingBytes}) {}

    PendingOutput output;
    FrameRecording frames;
    SessionTotals before;
    std::optional<std::uint64_t> first_id;  ///< of the session
};

CameraSettings with_setting(CameraSettings settings, const std::string& feature,
                            const std::string& value) {
    std::erase_if(settings, [&](const auto& setting) { return setting.first == feature; });
    settings.emplace_back(feature, value);
    return settings;
}

ViewedCamera::ViewedCamera(ViewedCameraOptions options)
    : options_(std::move(options)),
      settings_(options_.settings),
      session_(
          [this] {
              const std::lock_guard lock(settings_mutex_);
              return options_.open(settings_);
          },
          options_.session, [](const Camera&) { return kWaitingFrames + 1; }),
      description_(session_.description()),
      layout_(session_.layout()),
      frames_(kWaitingFrames, kRecordingBytes) {
    for (const Message& warning : description_.warnings) options_.warn(warning);
    // The camera has begun: its frames are received while the sensor is set up.
    receiver_ = std::jthread([this](const std::stop_token& stop) { receive(stop); });
    const FrameLight light(layout_, options_.black_level_dn);
    setup_ = set_up_sensor(options_.sensor, light.shape(), light.filter());
    sensor_ = std::make_unique<ViewedSensor>(options_.sensor, *setup_, light.filter());
    recent_ = std::make_unique<RecentSlots>(layout_, options_.black_level_dn,
                                            stream_header_of(*setup_, {}));
    ready_ = true;
    emulator_ = std::jthread([this] { emulate(); });
}

ViewedCamera::~ViewedCamera() {
    receiver_.request_stop();
    receiver_.join();
    if (emulator_.joinable()) emulator_.join();
}

std::string ViewedCamera::name() const {
    return fmt::format("{} {}", description_.vendor, description_.model);
}

void ViewedCamera::receive(const std::stop_token& stop) {
    try {
        while (!stop.stop_requested() && ended_.empty()) {
            take(session_.next(kPollInterval));
            run_tasks();
        }
    } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        ended_ = e.what();
    }
    {
        const std::lock_guard lock(mutex_);
        accepts_tasks_ = false;
    }
    run_tasks();
    if (recording_) end_recording();
    for (auto& finished : finishing_) finished.wait();
    frames_.close();
}

void ViewedCamera::run_tasks() {
    for (;;) {
        std::packaged_task<void()> task;
        {
            const std::lock_guard lock(mutex_);
            if (tasks_.empty()) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
}

void ViewedCamera::in_session(std::function<void()> task) {
    std::future<void> done;
    {
        const std::lock_guard lock(mutex_);
        if (!accepts_tasks_) throw DeviceError(options_.address, "sends no more frames: " + ended_);
        done = tasks_.emplace_back(std::move(task)).get_future();
    }
    done.get();
}

void ViewedCamera::take(SessionEvent event) {
    if (auto* const frame = std::get_if<CapturedFrame>(&event)) return take(std::move(*frame));
    if (std::holds_alternative<NoFrame>(event)) return;
    options_.tell(event);
    events_.add(event);
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) {
        const std::lock_guard lock(mutex_);
        ended_ = lost->reason;
    }
}

void ViewedCamera::take(CapturedFrame frame) {
    if (!ready_) return session_.give_back(std::move(frame.payload));
    const FrameRecord& record = frame.record;
    if (record.lost_before > 0) events_.add(loss_text(record));
    {
        const std::lock_guard lock(mutex_);
        rate_.add(record);
    }
    if (recording_) {
        CapturedFrame copy = frame;
        if (!recording_->first_id) {  // what was lost before is not of this recording
            recording_->first_id = record.id;
            copy.record.lost_before = 0;
            copy.record.cause = GapCause::kNone;
        }
        copy.record.id -= *recording_->first_id;
        if (!recording_->frames.push(std::move(copy))) session_.count_queue_drop(record);
        if (recording_->frames.failed()) end_recording();  // such as a full disk
    }
    const bool shown = record.status == FrameStatus::kComplete && record.layout == layout_ &&
                       frames_.push(std::move(frame));
    // push() leaves the frame that it refuses. NOLINTNEXTLINE(bugprone-use-after-move)
    if (!shown) session_.give_back(std::move(frame.payload));
    const std::lock_guard lock(mutex_);
    if (!shown) ++skipped_;
    totals_ = session_.totals();
    if (!recording_) return;
    recorded_ = totals_.frames - recording_->before.frames;
    lost_ = all_lost(totals_.lost) - all_lost(recording_->before.lost);
}

void ViewedCamera::emulate() {
    Emulator emulator(*setup_);
    FrameLight to_light(layout_, options_.black_level_dn);
    std::vector<float> light(to_light.shape().sites());
    while (auto frame = frames_.pop()) {
        to_light.convert(frame->payload, light);
        sensor_->apply(emulator.stats().slots,
                       [&](const SensorSetup& next) { return switch_to(emulator, next); });
        recent_->add(frame->payload, emulator.expose(light), frame->record.host_monotonic_ns);
        session_.give_back(std::move(frame->payload));
    }
    sensor_->end();
    recent_->end();
}

std::int64_t ViewedCamera::switch_to(Emulator& emulator, const SensorSetup& next) {
    const std::int64_t slot = emulator.stats().slots;
    check_switch(*setup_, next, slot);
    const auto header = recent_->header();
    ScheduleSwitch made = switch_of(next);
    made.slot = slot;
    made.number = static_cast<std::uint16_t>(last_switch(*header) + 1);
    if (const auto fault = JoinedExposures().fault(*header, made))
        throw InputError(setup_->schedule.name, *fault);
    emulator.switch_to(next);
    recent_->add(std::move(made));
    return slot;
}

void ViewedCamera::change_sensor(const std::string& changes) {
    sensor_->change(changes, events_);
}

void ViewedCamera::record() {
    in_session([this] {
        if (recording_) throw InputError(file_, "is being recorded; stop it first");
        auto recording =
            std::make_unique<Recording>(options_.folder / recording_name_now(),
                                        session_record(session_.description(), settings_));
        recording->before = session_.totals();
        recording_ = std::move(recording);
        const std::lock_guard lock(mutex_);
        file_ = recording_->output.final_path().string();
        recorded_ = lost_ = 0;
    });
}

void ViewedCamera::stop_recording() {
    in_session([this] {
        if (!recording_) throw InputError(options_.address, "is not being recorded");
        end_recording();
    });
}

/// A thread of its own waits for the disk.
void ViewedCamera::end_recording() {
    RecordingEnd end;
    const SessionTotals& now = session_.totals();
    for (std::size_t cause = 0; cause < end.lost.size(); ++cause)
        end.lost[cause] = now.lost[cause] - recording_->before.lost[cause];
    end.transport = session_.transport();
    {
        const std::lock_guard lock(mutex_);
        file_.clear();
    }
    finishing_.push_back(
        std::async(std::launch::async,
                   [this, end, recording = std::shared_ptr<Recording>(std::move(recording_))] {
                       const std::string file = recording->output.final_path().string();
                       try {
                           const RecordingResult made = recording->frames.finish(end);
                           events_.add(fmt::format("{}: {} frames, {} lost", file, made.end.frames,
                                                   all_lost(made.end.lost)));
                           if (made.failure) std::rethrow_exception(made.failure);
                       } catch (const Error& e) {  // names the file
                           events_.add(e.what());
                       } catch (const std::exception& e) {
                           events_.add(fmt::format("{}: {}", file, e.what()));
                       }
                   }));
}

void ViewedCamera::set(const std::string& feature, const std::string& value) {
    in_session([&] {
        session_.set(feature, value);
        const std::lock_guard lock(settings_mutex_);
        settings_ = with_setting(std::move(settings_), feature, value);
    });
    events_.add(fmt::format("{} = {}", feature, value));
}

CameraSettings ViewedCamera::settings() const {
    const std::lock_guard lock(settings_mutex_);
    return settings_;
}

bool ViewedCamera::records() const {
    const std::lock_guard lock(mutex_);
    return !file_.empty();
}

ordered_json ViewedCamera::status() const {
    const std::lock_guard lock(mutex_);
    ordered_json recording = nullptr;
    if (!file_.empty())
        recording = {{"file", file_}, {"frames", recorded_}, {"lost", lost_}, {"stop", true}};
    return {{"frames", totals_.frames},
            {"frames_hz", or_null(rate_.hz())},
            {"lost", json_of([&](const auto& add) { visit_lost_figures(totals_, add); })},
            {"incomplete", totals_.incomplete},
            {"outages", totals_.outages},
            {"skipped", skipped_},
            {"recording", recording},
            {"sensor", sensor_->json()},
            {"events", events_.json()},
            {"ended", ended_.empty() ? ordered_json(nullptr) : ordered_json(ended_)}};
}

}  // namespace stipple
