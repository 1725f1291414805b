#include "capture/v4l2/v4l2_camera.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "capture/frame_record.h"
#include "capture/v4l2/v4l2_buffers.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_settings.h"
#include "core/error.h"

namespace stipple {
namespace {

constexpr std::string_view kMemorySetting = "BufferMemory";

using Clock = std::chrono::steady_clock;

/// What the flags of a buffer say of its stamp.
StampSource stamp_source(std::uint32_t flags) {
    if ((flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
        return StampSource::kUnnamedClock;
    return (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE
               ? StampSource::kHostStartOfFrame
               : StampSource::kHostEndOfFrame;
}

CameraSettings controls_among(const CameraSettings& settings) {
    CameraSettings controls;
    for (const auto& setting : settings)
        if (!is_v4l2_format_setting(setting.first) && setting.first != kMemorySetting)
            controls.push_back(setting);
    return controls;
}

class V4l2Camera final : public Camera {
  public:
    V4l2Camera(const std::string& path, const CameraSettings& settings, V4l2Memory memory,
               int frames)
        : device_(path),
          format_(set_v4l2_format(device_, settings)),
          memory_(memory),
          buffers_(device_, memory, frames, format_.buffer_bytes) {
        set_v4l2_controls(device_, controls_among(settings));
    }
    ~V4l2Camera() override { stop(); }

    [[nodiscard]] CameraDescription description() const override;
    [[nodiscard]] FrameLayout layout() const override { return format_.layout; }
    [[nodiscard]] std::size_t buffer_bytes() const override {
        return format_.buffer_bytes * static_cast<std::size_t>(buffers_.count());
    }
    [[nodiscard]] std::uint64_t wire_id_period() const override { return std::uint64_t{1} << 32U; }
    [[nodiscard]] TransportCounts counts() const override { return counts_; }

    void start() override;
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout) override;
    void stop() noexcept override;
    void set(const std::string& feature, const std::string& value) override {
        set_v4l2_controls(device_, {{feature, value}});
        exposure_ = read_v4l2_exposure(device_);
    }

  private:
    [[nodiscard]] CapturedFrame frame_of(const V4l2Buffers::Filled& filled) const;
    void count(const V4l2Buffers::Filled& filled, bool waited);

    V4l2Device device_;
    V4l2Format format_;
    V4l2Memory memory_;
    V4l2Buffers buffers_;
    TransportCounts counts_;
    bool streaming_ = false;
    V4l2Exposure exposure_;  ///< as it was set when the stream started
    std::optional<std::uint32_t> last_sequence_;
    int ready_in_a_row_ = 0;
};

CameraDescription V4l2Camera::description() const {
    CameraDescription about;
    about.transport = "V4L2";
    about.address = device_.address();
    about.vendor = device_.driver();
    about.model = device_.card();
    about.features = read_v4l2_controls(device_);
    about.features["Width"] = std::to_string(format_.layout.width);
    about.features["Height"] = std::to_string(format_.layout.height);
    about.features["OffsetX"] = std::to_string(format_.layout.offset_x);
    about.features["OffsetY"] = std::to_string(format_.layout.offset_y);
    about.features["PixelFormat"] = format_.layout.format->name;
    if (format_.frames_hz > 0)
        about.features["AcquisitionFrameRate"] = fmt::format("{:.6g}", format_.frames_hz);
    about.transport_facts = format_.facts;
    about.transport_facts["bus"] = device_.bus();
    about.transport_facts["driver"] = device_.driver();
    about.transport_facts["driver_version"] = device_.version();
    about.transport_facts["api"] = device_.multi_planar() ? "multi-planar" : "single-planar";
    about.transport_facts["buffer_memory"] = memory_ == V4l2Memory::kDriver ? "driver" : "own";
    about.transport_facts["buffers"] = std::to_string(buffers_.count());
    return about;
}

void V4l2Camera::start() {
    if (streaming_) return;
    counts_ = {};
    last_sequence_.reset();
    ready_in_a_row_ = 0;
    exposure_ = read_v4l2_exposure(device_);
    const int error = buffers_.queue_all();
    if (buffers_.queued() == 0)
        throw DeviceError(device_.address(), fmt::format("the driver takes no frame buffer: {}",
                                                         std::strerror(error)));
    std::uint32_t type = device_.buffer_type();
    try {
        device_.demand(VIDIOC_STREAMON, &type, "start its stream");
    } catch (...) {
        // Buffers that were queued stay with the driver until a stop.
        static_cast<void>(device_.call(VIDIOC_STREAMOFF, &type));
        buffers_.all_ours();
        throw;
    }
    streaming_ = true;
}

void V4l2Camera::stop() noexcept {
    if (!streaming_) return;
    std::uint32_t type = device_.buffer_type();
    static_cast<void>(device_.call(VIDIOC_STREAMOFF, &type));  // fails if the device is gone
    buffers_.all_ours();
    streaming_ = false;
}

Arrival V4l2Camera::wait(std::chrono::milliseconds timeout) {
    if (!streaming_) return DeviceLost{"the stream is not started"};
    const auto until = Clock::now() + timeout;
    buffers_.queue_all();
    auto readiness = V4l2Device::Readiness::kReady;
    bool waited = false;
    for (;;) {
        V4l2Buffers::Filled filled;
        const int error = buffers_.fetch(filled);
        if (error == 0) {
            count(filled, waited);
            Arrival frame = frame_of(filled);
            buffers_.release(filled.index);
            buffers_.queue_all();
            return frame;
        }
        if (error != EAGAIN)
            return DeviceLost{fmt::format("the driver ended the stream: {}", std::strerror(error))};
        if (readiness == V4l2Device::Readiness::kError)
            return DeviceLost{"the driver reports an error of the stream"};
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
        if (left.count() <= 0) return NoFrame{};
        waited = true;
        readiness = device_.wait_readable(left);
    }
}

/// Frames that were lost while all buffers were full: the number after the gap follows on a run of
/// at least as many frames as there are buffers, none of which had to be waited for.
void V4l2Camera::count(const V4l2Buffers::Filled& filled, bool waited) {
    const std::uint32_t step = last_sequence_ ? filled.sequence - *last_sequence_ : 1;
    constexpr std::uint32_t kBackwards = 1U << 31U;
    if (step > 1 && step < kBackwards && ready_in_a_row_ >= buffers_.count())
        counts_.underruns += step - 1;
    ready_in_a_row_ = waited ? 0 : ready_in_a_row_ + 1;
    last_sequence_ = filled.sequence;
}

CapturedFrame V4l2Camera::frame_of(const V4l2Buffers::Filled& filled) const {
    CapturedFrame frame;
    frame.payload = pool().take();
    FrameRecord& record = frame.record;
    record.host_monotonic_ns = monotonic_ns();
    record.host_realtime_ns = realtime_ns();
    record.wire_id = filled.sequence;
    record.stamp_source = stamp_source(filled.flags);
    record.device_ns = filled.stamp_ns;
    record.exposure_us = exposure_.exposure_us;
    record.gain = exposure_.gain;
    record.black_level_dn = exposure_.black_level_dn;
    record.layout = format_.layout;
    record.bytes_received = filled.bytes.size();
    const std::size_t size = record.layout.payload_bytes();
    const std::size_t got = std::min(size, filled.bytes.size());
    // Drivers may count the padding behind the last row, but no less than the pixels.
    if (got < size || filled.overflow) record.status = FrameStatus::kSizeMismatch;
    if ((filled.flags & V4L2_BUF_FLAG_ERROR) != 0) record.status = FrameStatus::kDeviceError;
    frame.payload.reserve(size);
    frame.payload.assign(filled.bytes.begin(),
                         filled.bytes.begin() + static_cast<std::ptrdiff_t>(got));
    frame.payload.resize(size);
    if (got < size) frame.holes.emplace_back(got, size);
    return frame;
}

V4l2Memory memory_setting(const std::string& address, const CameraSettings& settings) {
    auto memory = V4l2Memory::kDriver;
    for (const auto& [name, value] : settings) {
        if (name != kMemorySetting) continue;
        if (value != "driver" && value != "own")
            throw InputError(address,
                             fmt::format("BufferMemory: \"{}\" is neither driver nor own", value));
        memory = value == "own" ? V4l2Memory::kOwn : V4l2Memory::kDriver;
    }
    return memory;
}

}  // namespace

std::unique_ptr<Camera> open_v4l2_camera(const std::string& address, const CameraSettings& settings,
                                         const CameraBuffers& buffers) {
    constexpr int kMin = CameraBuffers::kMinFrames;
    constexpr int kMax = CameraBuffers::kMaxFrames;
    if (buffers.frames < kMin || buffers.frames > kMax)
        throw InputError(
            address, fmt::format("{} frame buffers: take {} to {}", buffers.frames, kMin, kMax));
    return std::make_unique<V4l2Camera>(v4l2_node_path(address), settings,
                                        memory_setting(address, settings), buffers.frames);
}

}  // namespace stipple
