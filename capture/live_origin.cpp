#include "capture/live_camera.h"

#include <fmt/format.h>

#include <random>

#include "capture/camera_kind.h"
#include "capture/recording/recording_reader.h"
#include "capture/recording/replay_camera.h"
#include "readout/footage_origin.h"

namespace stipple {
namespace {

/// A random number: packets of two recordings with the same settings are told apart by it
/// (docs/stream_format.md, "Packet").
std::string new_recording_name() {
    std::random_device random;
    return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

FootageOrigin live_origin(const std::string& address, const LiveCamera& camera,
                          double black_level_dn, const std::function<void()>& check) {
    FootageOrigin origin{.name = camera.description().model};
    if (camera_kind(address).is_replay) {
        const std::string file(replayed_file(address));
        origin = origin_of(file, FootageOptions{}, check);
        if (!is_recording(file)) origin.pixel_format = camera.layout().format->name;
    } else {
        origin.recording = new_recording_name();
    }
    origin.black_level_dn = black_level_dn;
    return origin;
}

}  // namespace stipple
