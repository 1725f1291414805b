#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/frame_record.h"
#include "core/error.h"

namespace stipple {

/// Identity and settings of a camera: the session record of a recording.
struct CameraDescription {
    std::string transport;  ///< "GigE Vision", "USB3 Vision", "V4L2", "replay"
    std::string address;    ///< argument of `open`: "gige:192.168.0.5", "v4l2:/dev/video0"
    std::string vendor;
    std::string model;
    std::string serial;
    std::string firmware;
    std::string genicam_xml_hash;                 ///< XXH3 as hex; empty without GenICam
    std::map<std::string, std::string> features;  ///< every readable feature or control, as text
    std::map<std::string, std::string> transport_facts;  ///< packet size, MTU, socket buffer, ...
    std::vector<Message> warnings = {};  ///< risks of lost frames, each with its fix
};

/// Nothing arrived within the timeout.
struct NoFrame {};

/// The device is gone or its stream failed, so it has to be opened again; or a replay has reached
/// its end.
struct DeviceLost {
    std::string reason;
    bool at_end = false;  ///< end of a replay, no fault
    /// Replay: why its file cannot be read further.
    std::optional<InputError> bad_file = {};
    Message warning = {};  ///< replay at its end: faults of its file
};

/// Result of `Camera::wait`. The camera fills these fields of the frame record: wire_id, status,
/// stamps, exposure, gain, black level, layout, bytes_received. CaptureSession unwraps ids and adds
/// gaps and epochs.
using Arrival = std::variant<CapturedFrame, NoFrame, DeviceLost>;

/// Losses since `start` that the transport counts without naming the frame.
struct TransportCounts {
    std::uint64_t underruns = 0;  ///< no free buffer for a frame, or for a packet (GigE Vision)
    std::uint64_t packets_resent = 0;
    std::uint64_t packets_missing = 0;
    std::uint64_t socket_drops = 0;  ///< datagrams dropped by the full socket of the host
    std::uint64_t link_faults = 0;   ///< frames dropped by the interface, and link failures
    std::uint64_t size_mismatches = 0;
};

/// The begin of a stream.
struct StreamStart {
    std::uint64_t first_wire_id = 0;  ///< by the rule of the transport: 1 for GigE Vision
    std::int64_t monotonic_ns = 0;    ///< CLOCK_MONOTONIC, just before the camera was told to begin
};

/// Memory for the payloads of a number of frames. It is allocated in advance, and all of its pages
/// are written to, so that the resident memory of a program does not depend on how many frames
/// wait in its queues. Any thread may use it.
class FramePool {
  public:
    /// Makes memory for `frames` payloads of `bytes` bytes each. Called once.
    void reserve(std::size_t frames, std::size_t bytes);

    /// An empty payload with memory of the pool; if no more is left, without memory.
    [[nodiscard]] std::vector<std::uint8_t> take();
    /// Keeps the memory of a payload for a later one, but no more payloads than were reserved.
    void give_back(std::vector<std::uint8_t>&& payload);

    /// Number of payloads without memory so far.
    [[nodiscard]] std::uint64_t misses() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::vector<std::uint8_t>> free_;
    std::size_t frames_ = 0;
    std::size_t bytes_ = 0;  ///< of a payload
    std::uint64_t misses_ = 0;
};

/// A source of frames: GenICam through Aravis, V4L2, or a replayed recording. The function that
/// opens it applies the settings; then it is started once. Used from one thread.
class Camera {
  public:
    virtual ~Camera() = default;
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;

    [[nodiscard]] virtual CameraDescription description() const = 0;
    [[nodiscard]] virtual FrameLayout layout() const = 0;
    /// Memory of its buffers for frames.
    [[nodiscard]] virtual std::size_t buffer_bytes() const { return 0; }
    /// Wire ids count modulo this (65535 for GigE Vision without 0, 2^32 for V4L2).
    [[nodiscard]] virtual std::uint64_t wire_id_period() const = 0;
    /// Of the last `start`, if the transport has a rule for the first wire id.
    [[nodiscard]] virtual std::optional<StreamStart> stream_start() const { return {}; }
    [[nodiscard]] virtual TransportCounts counts() const = 0;

    /// \throws DeviceError if the device refuses; the message says what to do.
    virtual void start() = 0;
    /// Waits for the next frame. Faults of a streaming device never throw.
    [[nodiscard]] virtual Arrival wait(std::chrono::milliseconds timeout) = 0;
    virtual void stop() noexcept = 0;
    /// Sets a feature or control while frames come; later frames have it. \throws InputError if
    /// there is no such setting, its value is out of range, or it changes the layout of frames;
    /// DeviceError if the device refuses.
    virtual void set(const std::string& feature, const std::string& value);

    /// Payloads of later frames have the memory of `pool`, which must outlive the camera. By
    /// default each frame has memory of its own.
    void use(FramePool& pool) { pool_ = &pool; }

  protected:
    Camera() = default;
    /// Where `wait` takes the payloads of its frames from.
    [[nodiscard]] FramePool& pool() const { return *pool_; }

  private:
    FramePool without_memory_;
    FramePool* pool_ = &without_memory_;
};

/// Settings of a camera as text, by the name of the GenICam feature or V4L2 control. `Width`,
/// `Height`, `OffsetX`, `OffsetY`, `PixelFormat`, `AcquisitionFrameRate` and `ExposureTime` mean
/// the same for all cameras.
using CameraSettings = std::vector<std::pair<std::string, std::string>>;

/// The text of a camera setting as an integer, decimal or 0x...; empty for any other text, or out
/// of range.
[[nodiscard]] std::optional<std::int64_t> integer_setting(std::string_view text);

/// The same as a finite number; empty for any other text.
[[nodiscard]] std::optional<double> number_setting(std::string_view text);

/// Buffers for frames on the host.
struct CameraBuffers {
    static constexpr int kMinFrames = 2;
    static constexpr int kMaxFrames = 1024;

    int frames = 32;
    int socket_frames = 4;  ///< GigE Vision: frames in the receive buffer of the socket
};

/// The shortest frame period that the settings of a camera allow; 0 if they do not tell.
[[nodiscard]] std::chrono::nanoseconds nominal_period(const CameraDescription& camera);

/// Whether triggers decide when a frame comes.
[[nodiscard]] bool waits_for_triggers(const CameraDescription& camera);

/// Number of frames that a camera has sent before `first`, the first one that arrived. Some cameras
/// begin with another id, although the standard says which. So the difference of the ids counts
/// only if the camera had the time for so many frames since its start, by its nominal period (10 %
/// tolerance). It is 0 if the period is not known, and if triggers decide.
[[nodiscard]] std::uint64_t frames_before_first(const CameraDescription& camera,
                                                const StreamStart& start, const FrameRecord& first);

}  // namespace stipple
