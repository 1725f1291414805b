#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "capture/camera.h"

namespace stipple {

/// How the address of a replay begins, before the colon.
inline constexpr std::string_view kReplayPrefix = "replay";

/// PATH of an address "replay:PATH"; empty of any other.
[[nodiscard]] constexpr std::string_view replayed_file(std::string_view address) {
    if (!address.starts_with(kReplayPrefix)) return {};
    const std::string_view rest = address.substr(kReplayPrefix.size());
    return rest.starts_with(':') ? rest.substr(1) : std::string_view();
}

/// A recording, or footage, that comes as if a camera sent it. `address` is "replay:PATH".
///
/// Settings: `AcquisitionFrameRate` in Hz, 0 for as fast as it is taken (default: a recording by
/// its stamps, footage at 200 Hz); `Loop` 0 or 1; `PixelFormat` of footage, Mono8 or Mono16, of
/// footage in colour RGB8, or BayerRG8 ... BayerBG16.
///
/// Payloads, device stamps, exposure, gain, black level, layout, status and holes are those of the
/// recording, and wire ids leave out what it left out; arrival stamps are new. Whoever takes frames
/// later than `buffers.frames` of them loses the oldest, as with a camera: they count as underruns.
/// At the end comes DeviceLost (at_end), of a file that cannot be read further too (bad_file).
/// \throws InputError if the file is neither, or for a setting that it does not have.
[[nodiscard]] std::unique_ptr<Camera> open_replay_camera(const std::string& address,
                                                         const CameraSettings& settings,
                                                         const CameraBuffers& buffers);

}  // namespace stipple
