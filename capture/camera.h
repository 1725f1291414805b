#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/frame_record.h"
#include "core/error.h"

namespace stipple {

/// What identifies a camera, and what it was set to: the session record of a recording.
struct CameraDescription {
    std::string transport;  ///< "GigE Vision", "USB3 Vision", "V4L2", "replay"
    std::string address;    ///< what `open` takes: "gige:192.168.0.5", "v4l2:/dev/video0"
    std::string vendor;
    std::string model;
    std::string serial;
    std::string firmware;
    std::string genicam_xml_hash;                 ///< XXH3 as hex; empty without GenICam
    std::map<std::string, std::string> features;  ///< every readable feature or control, as text
    std::map<std::string, std::string> transport_facts;  ///< packet size, MTU, socket buffer, ...
    std::vector<std::string> warnings = {};  ///< what may cost frames, each with its fix
};

/// Nothing arrived within the timeout.
struct NoFrame {};

/// The device is gone, or its stream has failed for good; open it again. Or all frames of a replay
/// have come.
struct DeviceLost {
    std::string reason;
    bool at_end = false;  ///< the latter: no fault
    /// Of a replay: why its file cannot be used any further.
    std::optional<InputError> bad_file = {};
    std::string warning = {};  ///< of a replay: what is wrong with its file, which is at its end
};

/// What `Camera::wait` comes back with. Of the frame's record the camera fills what it knows:
/// wire_id, status, stamps, exposure, gain, black level, layout, bytes_received. Unwrapping of ids,
/// gaps and epochs is the session's part.
using Arrival = std::variant<CapturedFrame, NoFrame, DeviceLost>;

/// Losses that the transport counts but does not tie to a frame, since `start`.
struct TransportCounts {
    std::uint64_t underruns = 0;  ///< no buffer was free: for a frame, or a packet (GigE Vision)
    std::uint64_t packets_resent = 0;
    std::uint64_t packets_missing = 0;
    std::uint64_t socket_drops = 0;  ///< datagrams that the host's socket had no room for
    std::uint64_t link_faults = 0;   ///< frames that the interface dropped, and times its link went
    std::uint64_t size_mismatches = 0;
};

/// A source of frames: GenICam through Aravis, V4L2, or a recording played back. Configured by the
/// function that opens it, then started once. Used from one thread.
class Camera {
  public:
    virtual ~Camera() = default;
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;

    [[nodiscard]] virtual CameraDescription description() const = 0;
    [[nodiscard]] virtual FrameLayout layout() const = 0;
    /// Wire ids count modulo this (65535 for GigE Vision without 0, 2^32 for V4L2).
    [[nodiscard]] virtual std::uint64_t wire_id_period() const = 0;
    [[nodiscard]] virtual TransportCounts counts() const = 0;

    /// \throws DeviceError if the device refuses, with what to do.
    virtual void start() = 0;
    /// Waits for the next frame. Never throws for what a device does while it streams.
    [[nodiscard]] virtual Arrival wait(std::chrono::milliseconds timeout) = 0;
    virtual void stop() noexcept = 0;

  protected:
    Camera() = default;
};

/// Settings of a camera by feature name, as text: GenICam feature or V4L2 control; `Width`,
/// `Height`, `OffsetX`, `OffsetY`, `PixelFormat`, `AcquisitionFrameRate`, `ExposureTime` mean the
/// same for all.
using CameraSettings = std::vector<std::pair<std::string, std::string>>;

/// How frames wait on the host.
struct CameraBuffers {
    int frames = 32;        ///< 2 to 1024
    int socket_frames = 4;  ///< GigE Vision: what the socket's receive buffer is to hold
};

}  // namespace stipple
