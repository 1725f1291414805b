#include "apps/coded_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/interrupt.h"
#include "apps/leftovers.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/standard_error.h"
#include "capture/open_camera.h"
#include "capture/serve/coded_payload.h"
#include "capture/setting_value.h"
#include "core/error.h"
#include "io/pending_output.h"
#include "stream/packet_order.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWait{100};
/// A camera that sends nothing for so long has come to its end.
constexpr std::chrono::seconds kSilence{3};
/// A longer gap than this is no loss but another stream.
constexpr std::int64_t kMaxMissing = 1'000'000;

/// A feature that a camera with a coded stream must have.
std::string coded_feature(const CameraDescription& camera, const std::string& name) {
    const auto found = camera.features.find(name);
    if (found != camera.features.end()) return found->second;
    throw InputError(camera.address,
                     fmt::format("has no feature {}, so it sends no coded stream; record it "
                                 "without --coded, or serve one with --mode coded",
                                 name));
}

/// Writes slots as they come, and drops those that do not.
class SlotRecorder {
  public:
    SlotRecorder(const std::string& output, bool force, const CodedHeader& header)
        : header_(header),
          output_(output, force),
          writer_(output_.partial(), header.stream, output_.final_path().string()),
          order_(header.stream.shape.rows) {
        say_leftover(output_.final_path());
    }

    /// \throws DeviceError if the output cannot be written, InputError if slots are no stream.
    void take(const CapturedFrame& frame) {
        const CodedSlot slot = decode_coded_payload(header_, frame.payload, order_.expected());
        if (!slot.fault.empty()) ++damaged_;
        for (const SamplePacket& packet : slot.packets) {
            drop_before({packet.slot, packet.first_row});
            write(packet);
        }
    }
    /// Drops what is missing before `next`.
    void drop_before(StreamPosition next) {
        if (next.slot - order_.expected().slot > kMaxMissing)
            throw InputError("the coded stream", fmt::format("jumps from slot {} to {}",
                                                             order_.expected().slot, next.slot));
        while (order_.expected() < next) {
            const StreamPosition at = order_.expected();
            const int end = at.slot < next.slot ? header_.stream.shape.rows : next.row;
            if (at.row == 0) ++missing_;
            write({at.slot, at.row, end - at.row, SamplePacket::kDropped, {}});
        }
    }
    void finish() {
        try {
            writer_.finish();
        } catch (...) {
            keep();
            throw;
        }
        output_.commit();
    }
    /// The same where writing has failed: a stream as far as it goes.
    void keep() {
        output_.commit();
        say_kept(output_.final_path().c_str());
    }

    [[nodiscard]] std::int64_t slots() const { return order_.expected().slot; }
    [[nodiscard]] std::int64_t missing() const { return missing_; }
    [[nodiscard]] std::int64_t damaged() const { return damaged_; }

  private:
    void write(const SamplePacket& packet) {
        writer_.write(packet);
        order_.advance(packet.rows);
    }

    CodedHeader header_;
    PendingOutput output_;
    StreamWriter writer_;
    PacketOrder order_;
    std::int64_t missing_ = 0;
    std::int64_t damaged_ = 0;
};

/// How many slots there will be, 0 if that is not known. What is no number says nothing.
std::int64_t slots_to_come(const CameraDescription& camera,
                           const CameraRecordingArguments& arguments) {
    const auto told = camera.features.find("SourceFrameCount");
    const std::int64_t of_source =
        told == camera.features.end()
            ? 0
            : std::max<std::int64_t>(integer_setting(told->second).value_or(0), 0);
    const auto limit = arguments.limits.total();
    if (!limit) return of_source;
    return of_source == 0 ? *limit : std::min(*limit, of_source);
}

/// Until all slots are there (0: no number is known), the camera falls silent or goes, or somebody
/// stops it. True if it was not stopped.
bool record_slots(Camera& camera, SlotRecorder& recorder, std::int64_t slots, double seconds,
                  Progress& progress) {
    auto last = Clock::now();
    while (slots == 0 || recorder.slots() < slots) {
        if (stop_signal() != 0) return false;
        if (seconds > 0 && progress.seconds() >= seconds) return false;
        const auto now = Clock::now();
        const Arrival arrival = camera.wait(kWait);
        if (const auto* frame = std::get_if<CapturedFrame>(&arrival)) {
            recorder.take(*frame);
            progress.reach(static_cast<double>(recorder.slots()));
            if (recorder.missing() > 0)
                progress.note(fmt::format("{} missing", recorder.missing()));
            last = Clock::now();
        } else if (std::holds_alternative<DeviceLost>(arrival) || now - last > kSilence) {
            break;
        }
    }
    return true;
}

}  // namespace

void record_coded_stream(const CameraRecordingArguments& arguments, const RunOptions& run) {
    const auto camera = open_camera(arguments.camera.address, camera_settings(arguments.camera),
                                    arguments.camera.buffers);
    const CameraDescription description = camera->description();
    const CodedHeader header = decode_coded_header(coded_feature(description, "CodedStreamHeader"),
                                                   description.address + ": CodedStreamHeader");
    const std::int64_t slots = slots_to_come(description, arguments);
    JsonFile json(run);
    SlotRecorder recorder(arguments.output, run.force, header);
    camera->start();
    bool to_the_end = false;
    try {
        Progress progress(run, "recording", slots > 0 ? std::optional(slots) : std::nullopt);
        to_the_end = record_slots(*camera, recorder, slots, arguments.limits.seconds, progress);
    } catch (...) {
        if (recorder.slots() > 0) recorder.keep();
        throw;
    }
    camera->stop();
    if (recorder.slots() == 0) {
        throw_if_stopped();
        throw DeviceError(description.address, "no slot of the coded stream arrived");
    }
    if (to_the_end && slots > 0) recorder.drop_before({slots, 0});
    recorder.finish();
    json.write({{"slots", recorder.slots()},
                {"missing_slots", recorder.missing()},
                {"damaged_frames", recorder.damaged()}});
    run.say(fmt::format("{}: {}, {} of them missing, {} damaged", arguments.output,
                        counted(recorder.slots(), "slot"), recorder.missing(),
                        counted(recorder.damaged(), "frame")));
}

}  // namespace stipple
