#pragma once

#include <pybind11/pytypes.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <span>

#include "decoder/live_preview.h"
#include "python/camera.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple::python {

/// The preview that Python has asked for.
struct PreviewTask {
    pybind11::object show;  ///< called as show(PreviewFrame)
    PreviewOptions options;
};

/// The preview of a live emulation. Its thread decodes and knows nothing of Python: at idle
/// priority it could keep the GIL from the thread that records. The recording thread takes the
/// newest frame from it and calls Python between two frames of the camera.
class ShownPreview {
  public:
    /// `warnings` must outlive this. \throws InputError as PreviewDecoder.
    ShownPreview(PreviewTask task, StreamHeader header, SessionWarnings& warnings);

    /// As LivePreview::add. Without the GIL.
    void add(std::span<const SamplePacket> packets, std::int64_t arrival_ns) {
        preview_.add(packets, arrival_ns);
    }
    /// Calls Python if there is a new frame. Without the GIL. False if the call is to end, as
    /// Python has raised.
    [[nodiscard]] bool pass_on() noexcept;
    /// Waits for the first frame if there is none yet, unless `give_up` or Ctrl-C, and shows what
    /// Python has not seen. Without the GIL.
    void finish(bool give_up);
    /// Raises what Python has raised. With the GIL.
    void throw_raised();

    /// The key `preview` of "capture live" in docs/outputs.md, without its file. After `finish`.
    [[nodiscard]] pybind11::dict figures() const;

  private:
    void keep(const PreviewFrame& frame);
    void call(const PreviewFrame& frame);

    pybind11::object show_;
    std::exception_ptr raised_;
    std::mutex mutex_;
    std::optional<PreviewFrame> newest_;  ///< that Python has not seen
    std::atomic<bool> stopped_ = false;
    LivePreview preview_;  ///< last: its thread uses the others
};

}  // namespace stipple::python
