#include "capture/capture_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "capture/camera_reopener.h"
#include "capture/camera_timing.h"
#include "capture/frame_gap.h"
#include "capture/frame_ids.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr int kStallPeriods = 5;
/// How often the transport's counters are read while nothing is amiss: reading them costs more than
/// a frame of a fast camera does.
constexpr milliseconds kCountEvery{200};

/// From one frame to the next, by which a counter that began anew is known.
constexpr std::uint64_t kMaxSteps = 8;

TransportCounts sum(TransportCounts a, const TransportCounts& b) {
    a.underruns += b.underruns;
    a.packets_resent += b.packets_resent;
    a.packets_missing += b.packets_missing;
    a.socket_drops += b.socket_drops;
    a.link_faults += b.link_faults;
    a.size_mismatches += b.size_mismatches;
    return a;
}

/// Whether both are stamped, by the same clock.
bool have_stamps(const FrameRecord& a, const FrameRecord& b) {
    return a.stamp_source == b.stamp_source && a.stamp_source != StampSource::kNone;
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
    FrameGap gap;
    bool reconnected = false;               ///< no frame since
    std::optional<CapturedFrame> doubtful;  ///< a repeat, or the first of a counter that began anew
    std::optional<CapturedFrame> coming;    ///< that showed it was the latter

    TransportCounts earlier_epochs;
    TransportCounts counted;  ///< of this epoch, at `counted_at`
    Clock::time_point counted_at;
    bool incomplete_since = false;  ///< an incomplete frame since `counted_at`

    Clock::time_point last_sign;             ///< start, or the last frame that was no repeat
    nanoseconds silence{};                   ///< time of waiting in vain since then
    nanoseconds period_before{};             ///< of the epoch before
    std::optional<FrameRecord> first_frame;  ///< of this epoch
    std::optional<FrameRecord> last_frame;

    void take_over(std::unique_ptr<Camera> opened);
    [[nodiscard]] nanoseconds period() const;
    [[nodiscard]] std::optional<nanoseconds> stall_timeout() const;
    [[nodiscard]] SessionEvent begin_outage(std::string reason);
    [[nodiscard]] SessionEvent wait_for_camera(milliseconds timeout);
    [[nodiscard]] SessionEvent wait_for_frame(milliseconds timeout);
    void count_transport(bool now);
    void count_last_underruns();
    void number(FrameRecord& record);
    [[nodiscard]] std::uint64_t lost_at_start(const FrameRecord& record);
    void note_reconnection(const FrameRecord& record);
    void count_lost(std::uint64_t frames);
    void count_lost(GapCause cause, std::uint64_t frames);
    [[nodiscard]] bool begins_anew(const FrameRecord& record) const;
    [[nodiscard]] bool follows_doubtful(const FrameRecord& record) const;
    void drop_doubtful();
    [[nodiscard]] NoFrame drop(CapturedFrame frame);
    [[nodiscard]] SessionEvent take(CapturedFrame frame);
    [[nodiscard]] SessionEvent deliver(CapturedFrame frame);
};

void CaptureSession::Impl::take_over(std::unique_ptr<Camera> opened) {
    camera = std::move(opened);
    camera->use(pool);
    description = camera->description();
    layout = camera->layout();
    counted = {};
    counted_at = last_sign = Clock::now();
    silence = {};
    incomplete_since = false;
    first_frame.reset();
}

/// As measured in this epoch, else as set; 0 if neither is known.
nanoseconds CaptureSession::Impl::period() const {
    if (!first_frame || !last_frame || last_frame->id <= first_frame->id)
        return nominal_period(description);
    const auto frames = static_cast<std::int64_t>(last_frame->id - first_frame->id);
    return nanoseconds(
        std::max<std::int64_t>(0, last_frame->host_monotonic_ns - first_frame->host_monotonic_ns) /
        frames);
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
    drop_doubtful();
    period_before = period();
    count_transport(true);
    earlier_epochs = sum(earlier_epochs, std::exchange(counted, {}));
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

void CaptureSession::Impl::count_transport(bool now) {
    if (!now && Clock::now() - counted_at < kCountEvery) return;
    const std::uint64_t unexplained = counted.underruns;
    counted = camera->counts();
    // An underrun always costs a frame: where none is missing yet, frames from before it wait.
    if (!now && first_frame) counted.underruns = unexplained;
    counted_at = Clock::now();
    incomplete_since = false;
}

/// Of a replay, after its last frame: no other will tell that they are missing.
void CaptureSession::Impl::count_last_underruns() {
    const std::uint64_t before = counted.underruns;
    count_transport(true);
    totals.lost[static_cast<std::size_t>(GapCause::kHostUnderrun)] += counted.underruns - before;
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

/// For the cause that the transport has counted since the last look.
void CaptureSession::Impl::count_lost(std::uint64_t frames) {
    const TransportCounts before = counted;
    const bool explained = incomplete_since;
    count_transport(true);
    count_lost(cause_of(before, counted, explained), frames);
}

void CaptureSession::Impl::count_lost(GapCause cause, std::uint64_t frames) {
    gap.add(cause, frames);
    totals.lost[static_cast<std::size_t>(cause)] += frames;
}

void CaptureSession::Impl::number(FrameRecord& record) {
    std::uint64_t lost = 0;
    if (reconnected) {
        note_reconnection(record);
    } else if (!last_frame) {
        lost = lost_at_start(record);
    } else if (first_frame && record.layout != layout) {
        ++epoch;
    }
    layout = record.layout;
    const FrameIds::Step step = ids.next(record.wire_id);
    if (step.restarted) ++epoch;
    record.id = step.id;
    record.epoch = epoch;
    lost += step.lost;
    if (lost > 0) {
        count_lost(lost);
    } else {
        count_transport(false);
    }
    if (record.status != FrameStatus::kComplete) incomplete_since = true;
}

/// Of a frame with a past id: its clock went on, or, of a camera without clock, its counter stands.
bool CaptureSession::Impl::begins_anew(const FrameRecord& record) const {
    return have_stamps(record, *last_frame) ? record.device_ns > last_frame->device_ns
                                            : record.wire_id == last_frame->wire_id;
}

bool CaptureSession::Impl::follows_doubtful(const FrameRecord& record) const {
    const FrameRecord& first = doubtful->record;
    const std::uint64_t steps = ids.steps(first.wire_id, record.wire_id);
    const bool is_older = have_stamps(record, first) && record.device_ns < first.device_ns;
    return steps > 0 && steps <= kMaxSteps && !is_older;
}

void CaptureSession::Impl::drop_doubtful() {
    if (!doubtful) return;
    ++totals.repeated;
    static_cast<void>(drop(*std::exchange(doubtful, {})));
}

/// Without a count.
NoFrame CaptureSession::Impl::drop(CapturedFrame frame) {
    pool.give_back(std::move(frame.payload));
    return {};
}

SessionEvent CaptureSession::Impl::take(CapturedFrame frame) {
    const FrameRecord& record = frame.record;
    const bool is_past = !reconnected && ids.is_past(record.wire_id);
    // A packet that was resent too late: Aravis makes a frame of it again, long after the frame.
    if (is_past && record.status != FrameStatus::kComplete) return drop(std::move(frame));
    if (is_past && doubtful && follows_doubtful(record)) {
        coming = std::move(frame);
        return deliver(*std::exchange(doubtful, {}));
    }
    drop_doubtful();
    if (!is_past || begins_anew(record)) return deliver(std::move(frame));
    doubtful = std::move(frame);
    return NoFrame{};
}

SessionEvent CaptureSession::Impl::deliver(CapturedFrame frame) {
    FrameRecord& record = frame.record;
    last_sign = Clock::now();
    silence = {};
    number(record);
    last_frame = record;
    if (!first_frame) first_frame = record;
    const bool complete = record.status == FrameStatus::kComplete;
    const bool dropped =
        !complete && (options.incomplete == IncompletePolicy::kDrop ||
                      (options.incomplete == IncompletePolicy::kMask && frame.holes.empty()));
    if (dropped) {
        count_lost(GapCause::kQueueDrop, 1);
        return drop(std::move(frame));
    }
    if (options.incomplete == IncompletePolicy::kKeep) frame.holes.clear();
    record.lost_before = gap.total();
    record.cause = gap.cause();
    gap = {};
    if (totals.frames++ == 0) totals.missing_before_first = record.lost_before;
    if (!complete) ++totals.incomplete;
    return frame;
}

SessionEvent CaptureSession::Impl::wait_for_frame(milliseconds timeout) {
    if (coming) return deliver(*std::exchange(coming, {}));
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
        count_last_underruns();
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

void CaptureSession::give_back(std::vector<std::uint8_t>&& payload) {
    impl_->pool.give_back(std::move(payload));
}

std::uint64_t CaptureSession::late_allocations() const {
    return impl_->pool.misses();
}

void CaptureSession::count_queue_drop(const FrameRecord& record) noexcept {
    impl_->gap.add(record.cause, record.lost_before);
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
    return impl_->camera ? sum(impl_->earlier_epochs, impl_->camera->counts())
                         : impl_->earlier_epochs;
}

}  // namespace stipple
