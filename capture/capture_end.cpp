#include "capture/capture_end.h"

#include <optional>

#include "core/error.h"

namespace stipple {
namespace {

/// \throws the failure, or what is wrong with the file of a replay.
void throw_failure(const std::exception_ptr& failure, const std::optional<DeviceLost>& lost) {
    if (failure) std::rethrow_exception(failure);
    if (lost && lost->bad_file) throw InputError(*lost->bad_file);
}

}  // namespace

void throw_early_end(const CameraRecording& recording, const std::string& address) {
    const auto& lost = recording.lost;
    throw_failure(recording.failure, lost);
    if (lost && !lost->at_end) throw DeviceError(address, "camera lost: " + lost->reason);
    if (!recording.kept)
        throw DeviceError(address,
                          "no frame came; record for longer, or see \"stipple capture doctor\"");
}

void throw_early_end(const CodedRecording& recording, const std::string& address) {
    throw_failure(recording.failure, recording.lost);
    if (recording.lost) throw DeviceError(address, "camera lost: " + recording.lost->reason);
    if (!recording.kept) throw DeviceError(address, "no slot of the coded stream arrived");
}

bool commit_recording(StreamRecorder& recorder, LiveEmulation& emulation) {
    try {
        if (!emulation.failure) {
            recorder.finish();
            return false;
        }
    } catch (...) {
        emulation.failure = std::current_exception();
    }
    return recorder.keep();  // if not, the message of the failure says where it is
}

void throw_early_end(const LiveEmulation& emulation, const std::string& address) {
    const auto& end = emulation.end;
    throw_failure(emulation.failure, end);
    const bool empty = emulation.latencies.count() == 0;
    if (end && (empty || !end->at_end)) throw DeviceError(address, end->reason);
    if (empty) throw DeviceError(address, "no frame came");
}

}  // namespace stipple
