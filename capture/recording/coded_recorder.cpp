#include "capture/recording/coded_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "capture/camera.h"
#include "capture/serve/coded_payload.h"
#include "core/error.h"
#include "core/gap_limit.h"
#include "io/pending_output.h"
#include "stream/packet_order.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPollInterval{100};
/// A camera that sends nothing for so long has come to its end.
constexpr std::chrono::seconds kSilence{3};

CodedHeader header_of(const CameraDescription& camera) {
    constexpr auto kFeature = "CodedStreamHeader";
    const auto digits = camera.features.find(kFeature);
    if (digits == camera.features.end())
        throw InputError(camera.address,
                         fmt::format("has no feature {}, so it sends no coded stream; record it "
                                     "without ",
                                     kFeature) +
                             Parameter{"coded", "true"} + ", or serve one with " +
                             Parameter{"mode", "coded"});
    return decode_coded_header(digits->second, camera.address + ": " + kFeature);
}

/// What is not a number says nothing.
std::optional<std::int64_t> slots_to_come(const CameraDescription& camera,
                                          const CaptureLimits& limits) {
    std::optional<std::int64_t> slots = limits.total();
    const auto told = camera.features.find("SourceFrameCount");
    if (told == camera.features.end()) return slots;
    const auto of_source = integer_setting(told->second);
    if (!of_source || *of_source <= 0) return slots;
    return std::min(*of_source, slots.value_or(*of_source));
}

}  // namespace

struct CodedRecorder::Impl {
    Impl(std::unique_ptr<Camera> opened, const std::filesystem::path& file, bool force,
         const CaptureLimits& given)
        : camera(std::move(opened)),
          limits(given),
          header(header_of(camera->description())),
          slots(slots_to_come(camera->description(), limits)),
          output(file, force),
          writer(output.partial(), header.stream, output.final_path().string()),
          order(header.stream.shape.rows) {}

    [[nodiscard]] bool run(const Observer& progress);
    void take(const CapturedFrame& frame);
    [[nodiscard]] bool is_too_far(std::int64_t slot) const;
    void drop_before(StreamPosition next);
    void drop_rest();
    void write(const SamplePacket& packet);

    std::unique_ptr<Camera> camera;
    CaptureLimits limits;
    CodedHeader header;
    std::optional<std::int64_t> slots;
    PendingOutput output;
    StreamWriter writer;
    PacketOrder order;
    CodedRecording result;
};

/// True if all slots are there, or the camera sends no more; false if it was stopped or lost.
bool CodedRecorder::Impl::run(const Observer& progress) {
    const auto start = Clock::now();
    auto last = start;
    while (!slots || result.slots < *slots) {
        const auto now = Clock::now();
        const std::chrono::duration<double> elapsed = now - start;
        if (!progress(result) || (limits.seconds > 0 && elapsed.count() >= limits.seconds))
            return false;
        const Arrival arrival = camera->wait(kPollInterval);
        if (const auto* const frame = std::get_if<CapturedFrame>(&arrival)) {
            take(*frame);
            last = Clock::now();
        } else if (const auto* const lost = std::get_if<DeviceLost>(&arrival)) {
            if (!lost->at_end) result.lost = *lost;
            return lost->at_end;
        } else if (now - last > kSilence) {
            return true;
        }
    }
    return true;
}

void CodedRecorder::Impl::take(const CapturedFrame& frame) {
    const CodedSlot slot = decode_coded_payload(header, frame.payload, order.expected());
    if (!slot.fault.empty()) ++result.damaged_frames;
    for (const SamplePacket& packet : slot.packets) {
        drop_before({packet.slot, packet.first_row});
        write(packet);
    }
}

/// More slots before `slot` are missing than are in proportion to those that came.
bool CodedRecorder::Impl::is_too_far(std::int64_t slot) const {
    const std::int64_t missing = result.missing_slots + slot - order.expected().slot;
    const std::int64_t present = result.slots - result.missing_slots;
    return missing > max_missing_slots(present, header.stream.shape);
}

/// Writes dropped packets for what is missing before `next`. A gap that is too long is no loss but
/// another stream.
void CodedRecorder::Impl::drop_before(StreamPosition next) {
    if (is_too_far(next.slot))
        throw InputError("the coded stream",
                         fmt::format("jumps from slot {} to {}", order.expected().slot, next.slot));
    while (order.expected() < next) {
        const StreamPosition at = order.expected();
        const int end = at.slot < next.slot ? header.stream.shape.rows : next.row;
        if (at.row == 0) ++result.missing_slots;
        write({at.slot, at.row, end - at.row, SamplePacket::kDropped, {}});
    }
}

/// The slots that the camera has announced and not sent.
void CodedRecorder::Impl::drop_rest() {
    if (!slots || result.slots == 0) return;
    if (is_too_far(*slots))
        result.lost = DeviceLost{
            fmt::format("nothing came after slot {} of {}", order.expected().slot, *slots)};
    else
        drop_before({*slots, 0});
}

void CodedRecorder::Impl::write(const SamplePacket& packet) {
    writer.write(packet);
    order.advance(packet.rows);
    result.slots = order.expected().slot;
}

CodedRecorder::CodedRecorder(std::unique_ptr<Camera> camera, const std::filesystem::path& file,
                             bool force, const CaptureLimits& limits)
    : impl_(std::make_unique<Impl>(std::move(camera), file, force, limits)) {}

CodedRecorder::~CodedRecorder() = default;

std::optional<std::int64_t> CodedRecorder::slots() const {
    return impl_->slots;
}

CodedRecording CodedRecorder::record(const Observer& progress) {
    Impl& impl = *impl_;
    CodedRecording& result = impl.result;
    impl.camera->start();
    try {
        const bool to_the_end = impl.run(progress);
        impl.camera->stop();
        if (to_the_end) impl.drop_rest();
        if (result.slots > 0) impl.writer.finish();
    } catch (...) {
        result.failure = std::current_exception();
    }
    if (result.slots > 0) impl.output.commit();
    result.kept = impl.output.committed();
    return result;
}

}  // namespace stipple
