#include "capture/capture_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_reopener.h"
#include "capture/frame_ids.h"
#include "capture/loss_counter.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr int kStallPeriods = 5;

/// Whether the device's clock was set back between two frames, by more than its stamps scatter. The
/// stamp of an incomplete frame may be among what is missing.
bool is_set_back(const FrameRecord& before, const FrameRecord& after, nanoseconds period) {
    const auto has_stamp = [](const FrameRecord& frame) {
        return frame.status == FrameStatus::kComplete &&
               frame.stamp_source == StampSource::kDeviceClock;
    };
    return has_stamp(before) && has_stamp(after) && after.device_ns < before.device_ns &&
           before.device_ns - after.device_ns >= period.count();
}

bool is_dropped(const CapturedFrame& incomplete, IncompletePolicy policy) {
    return incomplete.record.status == FrameStatus::kOtherLayout ||
           policy == IncompletePolicy::kDrop ||
           (policy == IncompletePolicy::kMask && incomplete.holes.empty());
}

/// Why a frame of that status is incomplete.
GapCause cause_of(FrameStatus status) {
    if (status == FrameStatus::kOtherLayout) return GapCause::kLayout;
    return status == FrameStatus::kDeviceError ? GapCause::kDevice : GapCause::kTransport;
}

}  // namespace

struct CaptureSession::Impl {
    Opener open;
    SessionOptions options;
    FramePool pool;                                          ///< before the cameras, which use it
    std::unique_ptr<Camera> camera;                          ///< null during an outage
    std::vector<std::unique_ptr<CameraReopener>> reopeners;  ///< the last one is at work
    CameraDescription description;
    FrameLayout layout;
    FrameIds ids{2};
    std::uint32_t epoch = 0;
    SessionTotals totals;
    LossCounter losses;
    RepeatFilter repeats;
    bool reconnected = false;  ///< no frame since

    Clock::time_point last_sign;             ///< start, or the last frame that was no repeat
    nanoseconds silence{};                   ///< time of waiting in vain since then
    nanoseconds period_before{};             ///< of the last epoch that showed one
    std::optional<FrameRecord> first_frame;  ///< of this epoch
    std::optional<FrameRecord> last_frame;

    void take_over(std::unique_ptr<Camera> opened);
    [[nodiscard]] std::optional<nanoseconds> measured_period() const;
    [[nodiscard]] nanoseconds period() const;
    [[nodiscard]] std::optional<nanoseconds> stall_timeout() const;
    [[nodiscard]] SessionEvent begin_outage(std::string reason);
    [[nodiscard]] SessionEvent wait_for_camera(milliseconds timeout);
    [[nodiscard]] SessionEvent wait_for_frame(milliseconds timeout);
    void number(FrameRecord& record);
    [[nodiscard]] std::uint64_t lost_at_start(const FrameRecord& record);
    void note_reconnection(const FrameRecord& record);
    void count_lost(std::uint64_t frames);
    void count_lost(GapCause cause, std::uint64_t frames);
    void drop_repeat(std::optional<CapturedFrame> frame);
    [[nodiscard]] SessionEvent take(CapturedFrame frame);
    [[nodiscard]] SessionEvent deliver(CapturedFrame frame);
};

void CaptureSession::Impl::take_over(std::unique_ptr<Camera> opened) {
    camera = std::move(opened);
    camera->use(pool);
    description = camera->description();
    layout = camera->layout();
    last_sign = Clock::now();
    losses.begin_epoch(last_sign);
    silence = {};
    first_frame.reset();
}

/// Of this epoch.
std::optional<nanoseconds> CaptureSession::Impl::measured_period() const {
    if (!first_frame || !last_frame || last_frame->id <= first_frame->id) return std::nullopt;
    const auto frames = static_cast<std::int64_t>(last_frame->id - first_frame->id);
    return nanoseconds(
        std::max<std::int64_t>(0, last_frame->host_monotonic_ns - first_frame->host_monotonic_ns) /
        frames);
}

/// As measured in this epoch, else as set; 0 if neither is known.
nanoseconds CaptureSession::Impl::period() const {
    return measured_period().value_or(nominal_period(description));
}

/// How long the camera may be silent; empty: for ever.
std::optional<nanoseconds> CaptureSession::Impl::stall_timeout() const {
    if (options.stall <= milliseconds(0) || waits_for_triggers(description)) return std::nullopt;
    const nanoseconds several = kStallPeriods * period();
    const milliseconds least = first_frame ? options.stall : options.first_frame;
    return std::max<nanoseconds>(least, several);
}

SessionEvent CaptureSession::Impl::begin_outage(std::string reason) {
    ++totals.outages;
    if (!options.reconnect) {
        camera->stop();
        return DeviceLost{std::move(reason)};
    }
    drop_repeat(repeats.take_doubtful());
    // A camera that was lost again after one frame or none has shown no period.
    if (const auto measured = measured_period())
        period_before = *measured;
    else if (period_before.count() == 0)
        period_before = nominal_period(description);
    losses.end_epoch(*camera, Clock::now());
    std::erase_if(reopeners, [](const auto& old) { return old->is_done(); });
    reopeners.push_back(std::make_unique<CameraReopener>(std::move(camera), open));
    return Outage{std::move(reason)};
}

SessionEvent CaptureSession::Impl::wait_for_camera(milliseconds timeout) {
    auto back = reopeners.back()->take(timeout);
    if (back == nullptr) return NoFrame{};
    const double gone_s = std::chrono::duration<double>(Clock::now() - last_sign).count();
    take_over(std::move(back));
    reconnected = true;
    return Recovery{gone_s};
}

/// Frames that the camera would have sent while it was gone.
void CaptureSession::Impl::note_reconnection(const FrameRecord& record) {
    ++epoch;
    std::uint64_t missed = 0;
    const std::int64_t period_ns = period_before.count();
    if (last_frame && period_ns > 0) {
        const std::int64_t silent_ns = record.host_monotonic_ns - last_frame->host_monotonic_ns;
        missed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, silent_ns / period_ns - 1));
    }
    ids.restart(camera->wire_id_period(), missed);
    count_lost(GapCause::kReconnect, missed);
    reconnected = false;
}

/// Before the first frame of the session. Its id counts them.
std::uint64_t CaptureSession::Impl::lost_at_start(const FrameRecord& record) {
    const auto start = camera->stream_start();
    const std::uint64_t frames = start ? frames_before_first(description, *start, record) : 0;
    ids.restart(camera->wire_id_period(), frames);
    return frames;
}

void CaptureSession::Impl::count_lost(std::uint64_t frames) {
    losses.count_unexplained(*camera, frames, Clock::now());
    totals.lost = losses.lost();
}

void CaptureSession::Impl::count_lost(GapCause cause, std::uint64_t frames) {
    losses.count(cause, frames);
    totals.lost = losses.lost();
}

void CaptureSession::Impl::number(FrameRecord& record) {
    std::uint64_t lost = 0;
    bool begins_epoch = false;
    if (reconnected) {
        note_reconnection(record);
    } else if (!last_frame) {
        lost = lost_at_start(record);
    } else {
        begins_epoch =
            first_frame && (record.layout != layout || is_set_back(*last_frame, record, period()));
    }
    layout = record.layout;
    const FrameIds::Step step = ids.next(record.wire_id);
    if (begins_epoch || step.restarted) ++epoch;
    record.id = step.id;
    record.epoch = epoch;
    lost += step.lost;
    if (lost > 0) {
        count_lost(lost);
    } else {
        losses.note_frame(*camera, Clock::now());
    }
    if (record.status != FrameStatus::kComplete) losses.note_incomplete();
}

/// Counts it, unless a packet that was resent late made it.
void CaptureSession::Impl::drop_repeat(std::optional<CapturedFrame> frame) {
    if (!frame) return;
    if (frame->record.status == FrameStatus::kComplete) ++totals.repeated;
    pool.give_back(std::move(frame->payload));
}

SessionEvent CaptureSession::Impl::take(CapturedFrame frame) {
    const bool all_are_new = reconnected || !last_frame;
    RepeatFilter::Sorted sorted =
        repeats.take(std::move(frame), ids, all_are_new ? nullptr : &*last_frame);
    drop_repeat(std::move(sorted.left_out));
    if (!sorted.next) return NoFrame{};
    return deliver(std::move(*sorted.next));
}

SessionEvent CaptureSession::Impl::deliver(CapturedFrame frame) {
    FrameRecord& record = frame.record;
    last_sign = Clock::now();
    silence = {};
    number(record);
    last_frame = record;
    if (!first_frame) first_frame = record;
    const bool complete = record.status == FrameStatus::kComplete;
    if (!complete && is_dropped(frame, options.incomplete)) {
        count_lost(cause_of(record.status), 1);
        pool.give_back(std::move(frame.payload));
        return NoFrame{};
    }
    if (options.incomplete == IncompletePolicy::kKeep) frame.holes.clear();
    const FrameGap gap = losses.take_gap();
    record.lost_before = gap.total();
    record.cause = gap.cause();
    if (totals.frames++ == 0) totals.missing_before_first = record.lost_before;
    if (!complete) ++totals.incomplete;
    return frame;
}

SessionEvent CaptureSession::Impl::wait_for_frame(milliseconds timeout) {
    if (auto waiting = repeats.take_waiting()) return deliver(std::move(*waiting));
    const auto limit = stall_timeout();
    if (limit) {
        const auto left = std::chrono::ceil<milliseconds>(*limit - silence);
        timeout = std::clamp(left, milliseconds(0), std::max(timeout, milliseconds(0)));
    }
    const auto begun = Clock::now();
    Arrival arrival = camera->wait(timeout);
    // Where this program stood still for longer, frames may have come that it has not taken yet.
    silence += std::min<nanoseconds>(Clock::now() - begun, timeout);
    if (auto* frame = std::get_if<CapturedFrame>(&arrival)) return take(std::move(*frame));
    if (auto* lost = std::get_if<DeviceLost>(&arrival)) {
        if (!lost->at_end && !lost->bad_file) return begin_outage(std::move(lost->reason));
        losses.count_last_underruns(*camera, Clock::now());
        totals.lost = losses.lost();
        return std::move(*lost);
    }
    if (limit && silence >= *limit)
        return begin_outage(fmt::format("nothing came for {} ms",
                                        std::chrono::ceil<milliseconds>(silence).count()));
    return NoFrame{};
}

CaptureSession::CaptureSession(Opener open, SessionOptions options, const HeldFrames& held)
    : impl_(std::make_unique<Impl>()) {
    impl_->open = std::move(open);
    impl_->options = options;
    auto camera = impl_->open();
    impl_->ids = FrameIds(camera->wire_id_period());
    if (held) impl_->pool.reserve(held(*camera) + kOwnFrames, camera->layout().payload_bytes());
    camera->start();
    impl_->take_over(std::move(camera));
}

CaptureSession::~CaptureSession() {
    if (impl_->camera) impl_->camera->stop();
}

SessionEvent CaptureSession::next(std::chrono::milliseconds timeout) {
    return impl_->camera ? impl_->wait_for_frame(timeout) : impl_->wait_for_camera(timeout);
}

void CaptureSession::set(const std::string& feature, const std::string& value) {
    for (const char* of_layout : {"Width", "Height", "Offset", "PixelFormat", "Binning",
                                  "Decimation", "Input", "BufferMemory"})
        if (feature.starts_with(of_layout))
            throw InputError(feature,
                             "cannot change while frames come; start again with " +
                                 Parameter{"set", fmt::format("camera.{}={}", feature, value)});
    if (!impl_->camera) throw DeviceError(feature, "the camera is lost");
    impl_->camera->set(feature, value);
    impl_->description = impl_->camera->description();
    impl_->first_frame.reset();  // its period may be another one from now on
}

void CaptureSession::give_back(std::vector<std::uint8_t>&& payload) {
    impl_->pool.give_back(std::move(payload));
}

std::uint64_t CaptureSession::late_allocations() const {
    return impl_->pool.misses();
}

void CaptureSession::count_queue_drop(const FrameRecord& record) noexcept {
    impl_->losses.add_to_gap(record.cause, record.lost_before);
    impl_->count_lost(GapCause::kQueueDrop, 1);
    --impl_->totals.frames;
    if (record.status != FrameStatus::kComplete) --impl_->totals.incomplete;
}

const CameraDescription& CaptureSession::description() const {
    return impl_->description;
}

const FrameLayout& CaptureSession::layout() const {
    return impl_->layout;
}

const SessionTotals& CaptureSession::totals() const {
    return impl_->totals;
}

TransportCounts CaptureSession::transport() const {
    return impl_->losses.transport(impl_->camera.get());
}

}  // namespace stipple
