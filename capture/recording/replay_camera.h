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

/// A recording, or footage, in the role of a camera. `address` is "replay:PATH".
///
/// Settings: `AcquisitionFrameRate` in Hz, 0 for as fast as the caller takes frames (default: the
/// stamps of a recording, 200 Hz for footage); `Loop` 0 or 1; for footage `PixelFormat`: Mono8 or
/// Mono16, in colour RGB8 or BayerRG8 ... BayerBG16.
///
/// Payloads, device stamps, exposure, gain, black level, layout, status and holes are those of the
/// recording. Wire ids skip its missing frames. Arrival stamps are new. A caller that is more than
/// `buffers.frames` frames late loses the oldest, as with a camera; they count as underruns.
/// The end is DeviceLost with `at_end`, or with `bad_file` if the file cannot be read further.
/// \throws InputError if the file is neither recording nor footage, or for an unknown setting.
[[nodiscard]] std::unique_ptr<Camera> open_replay_camera(const std::string& address,
                                                         const CameraSettings& settings,
                                                         const CameraBuffers& buffers);

}  // namespace stipple
