#include "capture/recording/camera_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera.h"
#include "capture/frame_queue.h"
#include "capture/frame_record.h"
#include "capture/frame_sequence.h"
#include "capture/recording/frame_recording.h"
#include "io/pending_output.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPollInterval{100};

/// Frames of 10 s, for which a disk seldom stands still; memory for them is allocated in advance.
std::size_t reserved_frames(const Camera& camera) {
    constexpr std::chrono::seconds kDiskPause{10};
    constexpr std::int64_t kMinFrames = 64, kUsualFrames = 256, kMaxFrames = 4096;
    const std::chrono::nanoseconds period = nominal_period(camera.description());
    if (period.count() == 0) return kUsualFrames;
    return static_cast<std::size_t>(
        std::clamp<std::int64_t>(kDiskPause / period, kMinFrames, kMaxFrames));
}

}  // namespace

struct CameraRecorder::Impl {
    Impl(CaptureSession::Opener open, const CameraSettings& settings,
         const std::filesystem::path& file, CameraRecorderOptions given)
        : options(std::move(given)),
          output(file, options.force),
          session(std::move(open), options.session,
                  [this](const Camera& camera) { return plan_queue(camera); }),
          recording(output, session_record(session.description(), settings), waiting,
                    [this](std::vector<std::uint8_t>&& payload) {
                        session.give_back(std::move(payload));
                    }) {}

    /// Before it starts. Returns the frames to reserve memory for: waiting, and being written.
    [[nodiscard]] std::size_t plan_queue(const Camera& camera) {
        waiting = waiting_frames(camera, {.bytes = options.queue_bytes});
        return std::min(waiting.frames, reserved_frames(camera)) + 1;
    }

    void run(const Observer& progress);
    void take(SessionEvent event);
    void take(CapturedFrame frame);
    void note_failure();
    [[nodiscard]] std::string end_reason() const;
    void finish();

    CameraRecorderOptions options;
    PendingOutput output;
    WaitingFrames waiting;
    CaptureSession session;  ///< behind what is planned when it opens the camera
    FrameRecording recording;
    std::uint64_t taken = 0;  ///< frames that the recording took
    FrameRate rate;
    CameraRecording result;
};

void CameraRecorder::Impl::run(const Observer& progress) {
    const std::int64_t start_ns = monotonic_ns();
    const auto elapsed_s = [&] { return static_cast<double>(monotonic_ns() - start_ns) * 1e-9; };
    try {
        while (progress(taken, session.totals()) && !options.limits.reached(taken, elapsed_s()) &&
               !result.lost && !recording.failed())
            take(session.next(kPollInterval));
    } catch (...) {
        note_failure();
    }
    result.seconds = elapsed_s();
}

void CameraRecorder::Impl::take(SessionEvent event) {
    if (auto* const frame = std::get_if<CapturedFrame>(&event)) return take(std::move(*frame));
    if (std::holds_alternative<NoFrame>(event)) return;
    if (options.tell) options.tell(event);
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) result.lost = *lost;
}

void CameraRecorder::Impl::take(CapturedFrame frame) {
    const FrameRecord record = frame.record;
    if (recording.push(std::move(frame))) {
        rate.add(record);
        ++taken;
        return;
    }
    session.count_queue_drop(record);
    // push() leaves the frame that it refuses. NOLINTNEXTLINE(bugprone-use-after-move)
    session.give_back(std::move(frame.payload));
}

/// Of what is being thrown; the first one counts.
void CameraRecorder::Impl::note_failure() {
    if (!result.failure) result.failure = std::current_exception();
}

std::string CameraRecorder::Impl::end_reason() const {
    if (!result.lost) return "stopped";
    const bool gone = !result.lost->at_end && !result.lost->bad_file;
    return gone ? fmt::format("camera lost: {}", result.lost->reason) : result.lost->reason;
}

void CameraRecorder::Impl::finish() {
    RecordingEnd end;
    end.reason = end_reason();
    end.lost = session.totals().lost;
    end.transport = result.transport = session.transport();
    RecordingResult made = recording.finish(std::move(end), result.failure);
    result.end = std::move(made.end);
    result.kept = made.kept;
    result.failure = made.failure;
    result.session = session.totals();
    result.frames_hz = rate.hz();
}

CameraRecorder::CameraRecorder(CaptureSession::Opener open, const CameraSettings& settings,
                               const std::filesystem::path& file, CameraRecorderOptions options)
    : impl_(std::make_unique<Impl>(std::move(open), settings, file, std::move(options))) {}

CameraRecorder::~CameraRecorder() = default;

const CameraDescription& CameraRecorder::description() const {
    return impl_->session.description();
}

const std::filesystem::path& CameraRecorder::file() const {
    return impl_->output.final_path();
}

CameraRecording CameraRecorder::record(const Observer& progress) {
    impl_->run(progress);
    impl_->finish();
    return std::move(impl_->result);
}

}  // namespace stipple
