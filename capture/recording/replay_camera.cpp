#include "capture/recording/replay_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "capture/camera.h"
#include "capture/frame_record.h"
#include "capture/frame_sequence.h"
#include "capture/recording/replay_source.h"
#include "core/error.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

constexpr std::uint64_t kPeriod = std::uint64_t{1} << 32U;
constexpr nanoseconds kFootagePeriod{5'000'000};
constexpr nanoseconds kMaxPause{10'000'000'000};

struct ReplaySettings {
    std::string format;
    std::optional<double> rate_hz;
    bool loop = false;
};

ReplaySettings parse(const CameraSettings& settings) {
    ReplaySettings result;
    for (const auto& [name, value] : settings) {
        if (name == "PixelFormat") {
            result.format = value;
        } else if (name == "AcquisitionFrameRate") {
            result.rate_hz = number_setting(value);
            if (!result.rate_hz || *result.rate_hz < 0 || *result.rate_hz > 1e6)
                throw InputError(name, fmt::format("\"{}\" is not a rate of 0..1e6 Hz", value));
        } else if (name == "Loop") {
            if (value != "0" && value != "1")
                throw InputError(name, fmt::format("\"{}\" is neither 0 nor 1", value));
            result.loop = value == "1";
        } else {
            throw InputError(name,
                             "is not a setting of a replay; it has AcquisitionFrameRate, Loop and "
                             "PixelFormat");
        }
    }
    return result;
}

std::int64_t stamp_of(const FrameRecord& record) {
    return record.stamp_source == StampSource::kNone ? record.host_monotonic_ns : record.device_ns;
}

class ReplayCamera final : public Camera {
  public:
    ReplayCamera(std::string path, const ReplaySettings& settings, const CameraBuffers& buffers)
        : path_(std::move(path)),
          settings_(settings),
          buffers_(buffers),
          source_(path_, settings.format),
          layout_(source_.layout()) {
        if (!settings.rate_hz && !source_.is_recording()) settings_.rate_hz = 1e9 / 5e6;
        if (settings_.rate_hz && *settings_.rate_hz > 0)
            period_ = nanoseconds(static_cast<std::int64_t>(1e9 / *settings_.rate_hz));
    }

    [[nodiscard]] CameraDescription description() const override;
    [[nodiscard]] FrameLayout layout() const override { return layout_; }
    [[nodiscard]] std::uint64_t wire_id_period() const override { return kPeriod; }
    [[nodiscard]] TransportCounts counts() const override { return counts_; }
    void start() override {}
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout) override;
    void stop() noexcept override {}

  private:
    [[nodiscard]] bool paced() const { return !settings_.rate_hz || *settings_.rate_hz > 0; }
    bool load();
    void number_frame();
    void schedule_frame();
    CapturedFrame deliver();
    [[nodiscard]] DeviceLost end();

    std::string path_;
    ReplaySettings settings_;
    CameraBuffers buffers_;
    ReplaySource source_;
    FrameLayout layout_;
    TransportCounts counts_;
    CapturedFrame coming_;
    bool has_coming_ = false;
    GapFiller filler_;
    bool first_ = true;       ///< of the file: no stamp before it
    std::int64_t stamp_ = 0;  ///< of the frame before, as the file has it
    std::uint64_t next_id_ = 0;
    nanoseconds period_ = kFootagePeriod;
    Clock::time_point due_;
};

CameraDescription ReplayCamera::description() const {
    CameraDescription result;
    if (const SessionRecord* session = source_.session()) {
        result = session->camera;
        result.transport_facts["recorded_from"] = session->camera.address;
        result.transport_facts["recorded_transport"] = session->camera.transport;
    }
    result.transport = "replay";
    result.address = fmt::format("{}:{}", kReplayPrefix, path_);
    result.warnings = source_.warnings();
    return result;
}

/// The next frame of the file, or of the next round.
bool ReplayCamera::load() {
    if (coming_.payload.capacity() == 0) coming_.payload = pool().take();
    if (!source_.next(coming_)) {
        if (!settings_.loop) return false;
        source_.rewind();
        filler_ = {};
        first_ = true;
        if (!source_.next(coming_)) return false;
    }
    number_frame();
    schedule_frame();
    has_coming_ = true;
    return true;
}

/// Ids go on from round to round; ids that the recording lacks stay lacking.
void ReplayCamera::number_frame() {
    FrameRecord& record = coming_.record;
    next_id_ += std::min(filler_.next(record).held, kPeriod / 4);
    record.id = next_id_++;
    record.wire_id = record.id % kPeriod;
    record.lost_before = 0;
    record.cause = GapCause::kNone;
    record.epoch = 0;
    layout_ = record.layout;
}

void ReplayCamera::schedule_frame() {
    FrameRecord& record = coming_.record;
    const std::int64_t stamp = stamp_of(record);
    if (!settings_.rate_hz) {
        const auto pause = nanoseconds(static_cast<std::int64_t>(
            static_cast<std::uint64_t>(stamp) - static_cast<std::uint64_t>(stamp_)));
        if (!first_ && pause > nanoseconds{0} && pause <= kMaxPause) period_ = pause;
    }
    if (!source_.is_recording()) {
        record.stamp_source = StampSource::kDeviceClock;
        record.device_ns = static_cast<std::int64_t>(record.id) * period_.count();
    }
    due_ = record.id == 0 ? Clock::now() : due_ + period_;  // the clock starts with the first wait
    stamp_ = stamp;
    first_ = false;
}

CapturedFrame ReplayCamera::deliver() {
    has_coming_ = false;
    coming_.record.host_monotonic_ns = monotonic_ns();
    coming_.record.host_realtime_ns = realtime_ns();
    return std::exchange(coming_, {});
}

DeviceLost ReplayCamera::end() {
    return {.reason = path_ + " is at its end", .at_end = true, .warning = source_.end_warning()};
}

Arrival ReplayCamera::wait(std::chrono::milliseconds timeout) {
    const auto give_up = Clock::now() + timeout;
    try {
        for (;;) {
            if (!has_coming_ && !load()) return end();
            if (!paced()) return deliver();
            if (due_ > give_up) {
                std::this_thread::sleep_until(give_up);
                return NoFrame{};
            }
            std::this_thread::sleep_until(due_);
            if (Clock::now() - due_ <= buffers_.frames * period_) return deliver();
            ++counts_.underruns;
            has_coming_ = false;
        }
    } catch (const InputError& e) {
        return DeviceLost{.reason = e.what(), .bad_file = e};
    }
}

}  // namespace

std::unique_ptr<Camera> open_replay_camera(const std::string& address,
                                           const CameraSettings& settings,
                                           const CameraBuffers& buffers) {
    const std::string_view file = replayed_file(address);
    if (file.empty()) throw InputError(address, "is not a replay: write replay:FILE");
    return std::make_unique<ReplayCamera>(std::string(file), parse(settings), buffers);
}

}  // namespace stipple
