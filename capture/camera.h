#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/frame_pool.h"
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

/// Buffers for frames on the host.
struct CameraBuffers {
    static constexpr int kMinFrames = 2;
    static constexpr int kMaxFrames = 1024;

    int frames = 32;
    int socket_frames = 4;  ///< GigE Vision: frames in the receive buffer of the socket
};

}  // namespace stipple
