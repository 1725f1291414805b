#include "capture/recording/frame_recording.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <new>
#include <string>
#include <utility>

#include "core/version.h"

namespace stipple {
namespace {

std::string text_of(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        return "not enough memory";
    } catch (const std::exception& e) {
        return e.what();
    }
}

/// What `body` throws; of two failures the first one counts.
template <typename Body>
void note_failure_of(std::exception_ptr& failure, const Body& body) {
    try {
        body();
    } catch (...) {
        if (!failure) failure = std::current_exception();
    }
}

}  // namespace

SessionRecord session_record(const CameraDescription& camera, const CameraSettings& settings) {
    SessionRecord record;
    record.camera = camera;
    record.settings = settings;
    record.host = host_facts();
    record.host["stipple"] = version();
    record.started_realtime_ns = realtime_ns();
    return record;
}

std::string recording_name_now() {
    // Cameras that a script starts together share the second.
    const auto now = std::chrono::system_clock::now();
    const auto ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count();
    return fmt::format("{:%Y%m%d_%H%M%S}_{:03}.strec",
                       fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms % 1000);
}

FrameRecording::FrameRecording(PendingOutput& output, const SessionRecord& session,
                               const WaitingFrames& most, RecordingQueue::GiveBack give_back)
    : output_(output),
      writer_(output.partial(), session, output.final_path().string()),
      queue_(writer_, most, std::move(give_back)) {}

bool FrameRecording::push(CapturedFrame&& frame) {
    const bool taken = queue_.push(std::move(frame));
    if (!taken) ++refused_;
    return taken;
}

RecordingResult FrameRecording::finish(RecordingEnd end, std::exception_ptr failure) {
    RecordingResult result{.end = {}, .failure = std::move(failure)};
    note_failure_of(result.failure, [&] { queue_.drain(); });
    note_failure_of(result.failure, [&] {
        if (result.failure) end.reason = text_of(result.failure);
        // Frames that the queue took and could not write after all.
        end.lost[static_cast<std::size_t>(GapCause::kQueueDrop)] += queue_.dropped() - refused_;
        writer_.finish(std::move(end));
    });
    result.end.frames = writer_.frames();
    try {
        if (writer_.frames() > 0) output_.commit();
        result.end = writer_.totals();
    } catch (const std::bad_alloc&) {  // perhaps after the file was put in place
        if (!result.failure) result.failure = std::current_exception();
    }
    result.kept = output_.committed();
    return result;
}

}  // namespace stipple
