#include "capture/recording/recording_writer.h"

#include <algorithm>
#include <utility>

#include "capture/frame_payload.h"
#include "core/error.h"
#include "stream/crc32c.h"

namespace stipple {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& file, const SessionRecord& session,
                                 std::string where)
    : file_(file, where.empty() ? file.string() : std::move(where)) {
    file_.append(kRecordingMagic);
    append_block(BlockKind::kSession, bytes_of(encode_session(session)), {});
}

void RecordingWriter::append_block(BlockKind kind, std::span<const std::uint8_t> record,
                                   std::span<const std::uint8_t> payload) {
    const std::uint64_t start = file_.bytes();
    const auto header = encode_block_header(
        {kind, blocks_, static_cast<std::uint32_t>(record.size()), payload.size(), crc32c(record)});
    try {
        file_.append(header);
        file_.append(record);
        file_.append(payload);
    } catch (const DeviceError&) {
        file_.cut(start);
        throw;
    }
    ++blocks_;
}

void RecordingWriter::write(const CapturedFrame& frame) {
    auto record = encode_frame_record(frame);
    store_payload_hash(record, payload_hash(frame.payload));
    append_block(BlockKind::kFrame, record, frame.payload);
    count(frame.record, frame.payload.size());
}

void RecordingWriter::count(const FrameRecord& record, std::size_t payload_bytes) {
    ++totals_.frames;
    totals_.payload_bytes += payload_bytes;
    if (record.status != FrameStatus::kComplete) ++totals_.incomplete;
    totals_.lost[static_cast<std::size_t>(record.cause)] += record.lost_before;
    if (record.stamp_source != StampSource::kDeviceClock) return;
    if (clocks_.empty() || clocks_.back().epoch() != record.epoch)
        clocks_.emplace_back(record.epoch);
    clocks_.back().add(record.device_ns, record.host_monotonic_ns);
}

RecordingEnd RecordingWriter::totals() const {
    RecordingEnd result = totals_;
    for (const ClockFitter& clock : clocks_)
        if (const auto fit = clock.fit()) result.clocks.push_back(*fit);
    return result;
}

void RecordingWriter::finish(RecordingEnd end) {
    totals_.reason = std::move(end.reason);
    totals_.lost = end.lost;
    totals_.transport = end.transport;
    append_block(BlockKind::kEnd, bytes_of(encode_end(totals())), {});
    file_.close();
}

RecordingQueue::RecordingQueue(RecordingWriter& writer, const WaitingFrames& most,
                               GiveBack give_back)
    : writer_(writer),
      frames_(most.frames, most.bytes),
      give_back_(std::move(give_back)),
      thread_([this] { run(); }) {}

RecordingQueue::~RecordingQueue() {
    stop();
}

bool RecordingQueue::push(CapturedFrame&& frame) {
    const bool taken = frames_.push(std::move(frame));
    if (!taken) ++dropped_;
    return taken;
}

void RecordingQueue::run() {
    try {
        while (auto frame = frames_.pop()) {
            writer_.write(*frame);
            if (give_back_) give_back_(std::move(frame->payload));
        }
    } catch (...) {
        failure_ = std::current_exception();
        dropped_ += 1 + frames_.close_and_clear();
        failed_ = true;
    }
}

void RecordingQueue::stop() {
    frames_.close();
    if (thread_.joinable()) thread_.join();
}

void RecordingQueue::drain() {
    stop();
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace stipple
