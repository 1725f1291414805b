#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "capture/capture_session.h"
#include "capture/recording/recording_format.h"

namespace stipple {

struct CameraRecorderOptions {
    SessionOptions session = {};
    CaptureLimits limits = {};
    bool force = false;  ///< replaces a file of that name
    /// Bytes that may wait for the disk: 2 s of 640 x 480 pixels of 16 bits at 200 frames/s. Fewer
    /// if `max_memory` demands it.
    std::size_t queue_bytes = std::size_t{1} << 28U;
    /// Told of outages and recoveries, and of the end of the camera; may be empty.
    std::function<void(const SessionEvent&)> tell = {};
};

/// What became of a recording.
struct CameraRecording {
    RecordingEnd end;  ///< as it stands in the file
    SessionTotals session;
    TransportCounts transport;
    double seconds = 0;  ///< from the first wait for a frame to the last
    std::optional<double> frames_hz;
    bool kept = false;               ///< the file is in place; it is where a frame is in it
    std::optional<DeviceLost> lost;  ///< the camera that is gone, or a replay at its end
    std::exception_ptr failure;      ///< of the disk (DeviceError), or no memory
};

/// Records a camera to a .strec file: a session takes the frames, a thread writes them. Frames that
/// the disk is too slow for are dropped and counted. The memory of frames of 10 s is allocated
/// before the camera starts; only when more of them wait, the resident memory grows.
class CameraRecorder {
  public:
    /// Asked before each wait for a frame, every 100 ms at least, with the frames that are taken so
    /// far; false ends the recording.
    using Observer = std::function<bool(std::uint64_t frames, const SessionTotals& totals)>;

    /// Opens and starts the camera; `settings` are what the file says it was set to.
    /// \throws InputError, DeviceError as CaptureSession, PendingOutput and RecordingWriter.
    CameraRecorder(CaptureSession::Opener open, const CameraSettings& settings,
                   const std::filesystem::path& file, CameraRecorderOptions options);
    ~CameraRecorder();
    CameraRecorder(const CameraRecorder&) = delete;
    CameraRecorder& operator=(const CameraRecorder&) = delete;

    [[nodiscard]] const CameraDescription& description() const;
    /// Under which name the recording appears.
    [[nodiscard]] const std::filesystem::path& file() const;

    /// Records until a limit is reached, `progress` says no or the camera is lost, and puts the
    /// file in place, as far as it goes. Called once. \throws DeviceError, std::bad_alloc if it
    /// cannot be put in place.
    [[nodiscard]] CameraRecording record(const Observer& progress);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
