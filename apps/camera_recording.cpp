#include "apps/camera_recording.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/interrupt.h"
#include "apps/leftovers.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/session_report.h"
#include "apps/report/standard_error.h"
#include "capture/frame_rate.h"
#include "capture/host_clock.h"
#include "capture/recording/recording_queue.h"
#include "capture/recording/recording_writer.h"
#include "core/error.h"
#include "core/version.h"
#include "io/pending_output.h"

namespace stipple {
namespace {

using std::chrono::milliseconds;

/// What may wait for the disk: 2 s of 640 x 480 pixels of 16 bits at 200 frames/s.
constexpr std::size_t kQueueBytes = std::size_t{1} << 28U;

/// How often a signal is looked for.
constexpr milliseconds kPollInterval{100};

/// `output`, or a file in it that is named by the time.
std::filesystem::path file_for(const std::string& output) {
    std::filesystem::path path(output);
    if (!std::filesystem::is_directory(path)) return path;
    // Cameras that a script starts together share the second.
    const auto now = std::chrono::system_clock::now();
    const auto ms = std::chrono::duration_cast<milliseconds>(now.time_since_epoch()).count() % 1000;
    return path / fmt::format("{:%Y%m%d_%H%M%S}_{:03}.strec",
                              fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms);
}

SessionRecord session_record(const CameraDescription& camera, const CameraSettings& settings) {
    SessionRecord record;
    record.camera = camera;
    record.settings = settings;
    record.host = host_facts();
    record.host["stipple"] = version();
    record.started_realtime_ns = realtime_ns();
    return record;
}

std::string text_of(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        return "not enough memory";
    } catch (const std::exception& e) {
        return e.what();
    }
}

/// A recording at work, and what it has come to.
class CameraRecording {
  public:
    CameraRecording(const CameraRecordingArguments& arguments, const RunOptions& run)
        : arguments_(arguments),
          output_(file_for(arguments.output), run.force),
          settings_(camera_settings(arguments.camera)),
          session_([this] { return open(); }, session_options(arguments.camera, arguments.session)),
          writer_(output_.partial(), session_record(session_.description(), settings_),
                  output_.final_path().string()),
          queue_(writer_, kQueueBytes) {
        say_warnings(session_.description());
        say_leftover(output_.final_path());
    }

    void run(const RunOptions& run);
    void finish();
    [[nodiscard]] nlohmann::ordered_json json() const;
    [[nodiscard]] std::string text() const;

  private:
    [[nodiscard]] std::unique_ptr<Camera> open() const {
        return open_picture_camera(arguments_.camera, settings_);
    }
    [[nodiscard]] bool wants_more(double seconds) const;
    void note_failure();
    [[nodiscard]] RecordingEnd end_record() const;
    void take(CapturedFrame frame);
    void take(const NoFrame&) {}
    void take(const Outage& outage) { say(outage); }
    void take(const Recovery& recovery) { say(recovery); }
    void take(const DeviceLost& lost) {
        say_warning(lost.warning);
        at_end_ = lost.at_end;
        bad_file_ = lost.bad_file;
        const bool gone = !at_end_ && !bad_file_;
        end_reason_ = gone ? fmt::format("camera lost: {}", lost.reason) : lost.reason;
    }

    const CameraRecordingArguments& arguments_;
    PendingOutput output_;
    CameraSettings settings_;
    CaptureSession session_;
    RecordingWriter writer_;
    RecordingQueue queue_;
    std::uint64_t taken_ = 0;    ///< frames that the queue took
    std::uint64_t refused_ = 0;  ///< frames that it had no room for
    std::string end_reason_;
    bool at_end_ = false;  ///< of a replay
    std::optional<InputError> bad_file_;
    std::exception_ptr failure_;  ///< the first: of the disk, or no memory
    FrameRate rate_;
    double seconds_ = 0;
};

bool CameraRecording::wants_more(double seconds) const {
    return end_reason_.empty() && stop_signal() == 0 && !arguments_.limits.reached(taken_, seconds);
}

void CameraRecording::take(CapturedFrame frame) {
    const FrameRecord record = frame.record;
    if (queue_.push(std::move(frame))) {
        rate_.add(record);
        ++taken_;
        return;
    }
    ++refused_;
    session_.count_own_drop(record);
    if (queue_.failed()) end_reason_ = "the disk";  // `finish` finds out why
}

void CameraRecording::run(const RunOptions& run) {
    Progress progress(run, "recording", arguments_.limits.total());
    try {
        while (wants_more(progress.seconds())) {
            std::visit([this](auto&& event) { take(std::forward<decltype(event)>(event)); },
                       session_.next(kPollInterval));
            progress.reach(static_cast<double>(taken_));
            progress.note(losses_text(session_.totals()));
        }
    } catch (...) {
        note_failure();
    }
    seconds_ = progress.seconds();
}

/// Of what is being thrown.
void CameraRecording::note_failure() {
    if (!failure_) failure_ = std::current_exception();
}

RecordingEnd CameraRecording::end_record() const {
    RecordingEnd end;
    end.reason = end_reason_.empty() ? "stopped" : end_reason_;
    if (failure_) end.reason = text_of(failure_);
    end.lost = session_.totals().lost;
    // Frames that the queue took and could not write after all.
    end.lost[static_cast<std::size_t>(GapCause::kOwnDrop)] += queue_.dropped() - refused_;
    end.transport = session_.transport();
    return end;
}

void CameraRecording::finish() {
    try {
        queue_.drain();
    } catch (...) {
        note_failure();
    }
    try {
        writer_.finish(end_record());
    } catch (...) {
        note_failure();
    }
    if (writer_.frames() > 0)
        output_.commit();
    else
        throw_if_stopped();
    if ((failure_ || bad_file_) && output_.committed())
        say_kept(output_.final_path().c_str(),
                 [this] { return counted(writer_.frames(), "frame"); });
    if (failure_) std::rethrow_exception(failure_);
    if (bad_file_) throw InputError(*bad_file_);
    if (!end_reason_.empty() && !at_end_) throw DeviceError(arguments_.camera.address, end_reason_);
    if (writer_.frames() == 0)
        throw DeviceError(arguments_.camera.address,
                          "no frame came; record for longer, or see \"stipple capture doctor\"");
}

nlohmann::ordered_json CameraRecording::json() const {
    const RecordingEnd totals = writer_.totals();
    return {{"file", output_.final_path().string()},
            {"frames", totals.frames},
            {"incomplete", totals.incomplete},
            {"repeated", session_.totals().repeated},
            {"lost", lost_json(session_.totals())},
            {"outages", session_.totals().outages},
            {"transport", transport_json(session_.transport())},
            {"payload_bytes", totals.payload_bytes},
            {"seconds", seconds_},
            {"frames_per_s", rate_.hz() ? nlohmann::ordered_json(*rate_.hz()) : nullptr}};
}

std::string CameraRecording::text() const {
    const RecordingEnd totals = writer_.totals();
    std::string text = fmt::format(
        "{}: {}{}, {:.1f} MB", output_.final_path().string(), counted(totals.frames, "frame"),
        rate_.hz() ? fmt::format(", {:.1f} per second", *rate_.hz()) : "",
        static_cast<double>(totals.payload_bytes) * 1e-6);
    if (totals.incomplete > 0) text += fmt::format(", {} incomplete", totals.incomplete);
    if (const auto repeated = session_.totals().repeated; repeated > 0)
        text += fmt::format(", {} repeated and left out", repeated);
    return fmt::format("{}\nlost: {}", text, lost_text(session_.totals()));
}

}  // namespace

void record_camera(const CameraRecordingArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    CameraRecording recording(arguments, run);
    recording.run(run);
    recording.finish();
    json.write(recording.json());
    run.say(recording.text());
}

}  // namespace stipple
