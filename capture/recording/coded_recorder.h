#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "capture/camera.h"
#include "capture/capture_session.h"

namespace stipple {

/// What has become, so far, of the recording of a coded stream.
struct CodedRecording {
    std::int64_t slots = 0;
    std::int64_t missing_slots = 0;   ///< of these; they are dropped packets in the stream
    std::int64_t damaged_frames = 0;  ///< whose payload held something else behind its packets
    std::optional<DeviceLost> lost;   ///< the camera is lost; slots that it still held are absent
    bool kept = false;                ///< the file is in place; it is where a slot is in it
    std::exception_ptr failure;       ///< of the disk (DeviceError), or the stream (InputError)
};

/// Records a camera that sends a coded stream (coded_payload.h) to the .stipple file that `emulate`
/// would have written. Slots that do not arrive become dropped packets.
class CodedRecorder {
  public:
    /// Asked before each wait for a frame, every 100 ms at least; false ends the recording.
    using Observer = std::function<bool(const CodedRecording&)>;

    /// \throws InputError if the camera sends no coded stream; InputError, DeviceError as
    /// PendingOutput and StreamWriter.
    CodedRecorder(std::unique_ptr<Camera> camera, const std::filesystem::path& file, bool force,
                  const CaptureLimits& limits);
    ~CodedRecorder();
    CodedRecorder(const CodedRecorder&) = delete;
    CodedRecorder& operator=(const CodedRecorder&) = delete;

    /// The slots that there will be, if the camera or the limits say so.
    [[nodiscard]] std::optional<std::int64_t> slots() const;

    /// Records until all slots are there, a limit is reached, `progress` says no, or the camera is
    /// silent for 3 s or gone (`lost`), and puts the file in place, as far as it goes. Called once.
    /// \throws DeviceError if the camera refuses to start, or if the file cannot be put in place.
    [[nodiscard]] CodedRecording record(const Observer& progress);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
