#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "capture/frame_payload.h"
#include "capture/recording/recording_reader.h"
#include "capture/recording/recording_writer.h"
#include "core/philox.h"

namespace stipple {

inline SessionRecord test_session() {
    SessionRecord session;
    session.camera = {.transport = "GigE Vision",
                      .address = "gige:10.0.0.5",
                      .vendor = "Vendor",
                      .model = "Model \"M\"",
                      .serial = "S-1",
                      .firmware = "1.2",
                      .genicam_xml_hash = "0123456789abcdef",
                      .features = {{"ExposureTime", "1000"}, {"Gain", "2"}},
                      .transport_facts = {{"packet_size", "1500"}}};
    session.settings = {{"PixelFormat", "Mono16"}, {"Width", "12"}, {"Width", "13"}};
    session.host = {{"kernel", "Linux 6.1"}};
    session.started_realtime_ns = 1'700'000'000'000'000'000;
    return session;
}

/// A frame of `width` x `height` random samples, number `index` of a camera with 200 frames/s.
inline CapturedFrame test_frame(std::uint64_t index, const char* format = "Mono16", int width = 12,
                                int height = 5) {
    CapturedFrame frame;
    FrameRecord& record = frame.record;
    record.id = index;
    record.wire_id = index % 65535 + 1;
    record.stamp_source = StampSource::kDeviceClock;
    record.device_ns = 1'000'000'000 + static_cast<std::int64_t>(index) * 5'000'000;
    record.host_monotonic_ns = record.device_ns + 77'000;
    record.host_realtime_ns = record.device_ns + 1'700'000'000'000'000'000;
    record.layout.format = pixel_format_named(format);
    record.layout.width = width;
    record.layout.height = height;
    record.layout.stride_bytes = record.layout.format->row_bytes(width);
    frame.payload.resize(record.layout.payload_bytes());
    for (std::size_t i = 0; i < frame.payload.size(); ++i)
        frame.payload[i] = static_cast<std::uint8_t>(
            philox4x32({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(index), 0, 0},
                       5)[0] >>
            24U);
    record.bytes_received = frame.payload.size();
    record.payload_hash = payload_hash(frame.payload);
    return frame;
}

inline std::vector<CapturedFrame> test_frames(int count, const char* format = "Mono16") {
    std::vector<CapturedFrame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(test_frame(static_cast<std::uint64_t>(i), format));
    return frames;
}

inline void write_recording(const std::filesystem::path& file,
                            const std::vector<CapturedFrame>& frames) {
    RecordingWriter writer(file, test_session());
    for (const CapturedFrame& frame : frames) writer.write(frame);
    writer.finish({});
}

inline std::vector<CapturedFrame> read_frames(RecordingReader& reader) {
    std::vector<CapturedFrame> frames;
    for (CapturedFrame frame; reader.next(frame);) frames.push_back(frame);
    return frames;
}

inline bool same(const CapturedFrame& a, const CapturedFrame& b) {
    const FrameRecord& x = a.record;
    const FrameRecord& y = b.record;
    return x.id == y.id && x.wire_id == y.wire_id && x.epoch == y.epoch &&
           x.lost_before == y.lost_before && x.cause == y.cause && x.status == y.status &&
           x.stamp_source == y.stamp_source && x.device_ns == y.device_ns &&
           x.host_monotonic_ns == y.host_monotonic_ns && x.host_realtime_ns == y.host_realtime_ns &&
           x.exposure_us == y.exposure_us && x.gain == y.gain &&
           x.black_level_dn == y.black_level_dn && x.layout == y.layout &&
           x.bytes_received == y.bytes_received && x.payload_hash == y.payload_hash &&
           a.payload == b.payload && a.holes == b.holes;
}

inline bool same(const std::vector<CapturedFrame>& a, const std::vector<CapturedFrame>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!same(a[i], b[i])) return false;
    return true;
}

}  // namespace stipple
