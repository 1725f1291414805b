#include "capture/recording/recording_format.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <sys/utsname.h>
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/geometry.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

constexpr std::array kFields{
    RecordField{"id", "<u8"},
    RecordField{"wire_id", "<u8"},
    RecordField{"lost_before", "<u8"},
    RecordField{"device_ns", "<i8"},
    RecordField{"host_monotonic_ns", "<i8"},
    RecordField{"host_realtime_ns", "<i8"},
    RecordField{"exposure_us", "<f8"},
    RecordField{"gain", "<f8"},
    RecordField{"black_level_dn", "<f8"},
    RecordField{"bytes_received", "<u8"},
    RecordField{"payload_hash", "<u8"},
    RecordField{"stride_bytes", "<u8"},
    RecordField{"epoch", "<u4"},
    RecordField{"offset_x", "<u4"},
    RecordField{"offset_y", "<u4"},
    RecordField{"width", "<u4"},
    RecordField{"height", "<u4"},
    RecordField{"holes", "<u4"},
    RecordField{"cause", "u1"},
    RecordField{"status", "u1"},
    RecordField{"stamp_source", "u1"},
    RecordField{"packing", "u1"},
    RecordField{"filter", "u1"},
    RecordField{"planes", "u1"},
    RecordField{"bits_per_pixel", "u1"},
    RecordField{"significant_bits", "u1"},
    RecordField{"format", "S32"},
};

constexpr std::size_t kPayloadHashOffset = 80;
constexpr std::size_t kFormatNameBytes = 32;
constexpr std::uint32_t kMaxOffset = std::numeric_limits<std::int32_t>::max();

void append_format(std::vector<std::uint8_t>& bytes, const PixelFormat& format) {
    assert(format.name.size() < kFormatNameBytes);
    bytes.push_back(static_cast<std::uint8_t>(format.packing));
    bytes.push_back(static_cast<std::uint8_t>(format.filter));
    bytes.push_back(static_cast<std::uint8_t>(format.planes));
    bytes.push_back(static_cast<std::uint8_t>(format.bits_per_pixel));
    bytes.push_back(static_cast<std::uint8_t>(format.significant_bits));
    const std::size_t start = bytes.size();
    bytes.resize(start + kFormatNameBytes);
    std::copy(format.name.begin(), format.name.end(), bytes.data() + start);
}

/// The format that the 37 bytes from the packing on describe; nullptr if it is none of ours.
const PixelFormat* decode_format(const std::uint8_t* bytes) {
    const auto* const name = reinterpret_cast<const char*>(bytes + 5);
    const PixelFormat* format = pixel_format_named({name, strnlen(name, kFormatNameBytes)});
    if (format == nullptr) return nullptr;
    std::vector<std::uint8_t> expected;
    append_format(expected, *format);
    return std::equal(expected.begin(), expected.end(), bytes) ? format : nullptr;
}

double or_nan(const std::optional<double>& value) {
    return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::optional<double> unless_nan(double value) {
    if (std::isnan(value)) return std::nullopt;
    return value;
}

std::uint64_t bits_of(std::int64_t value) {
    return static_cast<std::uint64_t>(value);
}

/// Takes the numbers of a frame record, whose length has been checked, one after the other.
struct Fields {
    const std::uint8_t* at;
    template <Stored T>
    T take() {
        at += sizeof(T);
        return load<T>(at - sizeof(T));
    }
    std::int64_t take_signed() { return static_cast<std::int64_t>(take<std::uint64_t>()); }
};

std::string layout_problem(const FrameLayout& layout) {
    if (layout.format == nullptr) return "a pixel format that is not known";
    if (layout.width < 1 || layout.width > kMaxFrameSide || layout.height < 1 ||
        layout.height > kMaxFrameSide)
        return fmt::format("a frame that is not 1 to {} pixels wide and high", kMaxFrameSide);
    if (layout.stride_bytes < layout.format->row_bytes(layout.width) ||
        layout.stride_bytes > kMaxFramePayloadBytes / static_cast<std::uint64_t>(layout.height))
        return "a stride that does not fit its width";
    if (1.0 * layout.width * layout.height * layout.format->planes > double{kMaxFrameSites})
        return "more than 2^28 values";
    return {};
}

std::string take_holes(Fields fields, std::uint32_t count, std::uint64_t payload_bytes,
                       CapturedFrame& frame) {
    frame.holes.clear();
    std::uint64_t previous_end = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto begin = fields.take<std::uint64_t>();
        const auto end = fields.take<std::uint64_t>();
        if (begin < previous_end || end <= begin || end > payload_bytes)
            return "holes that are out of order or outside the payload";
        frame.holes.emplace_back(begin, end);
        previous_end = end;
    }
    return {};
}

}  // namespace

std::span<const RecordField> frame_record_fields() {
    return kFields;
}

std::uint64_t payload_hash(std::span<const std::uint8_t> payload) {
    return XXH3_64bits(payload.data(), payload.size());
}

std::array<std::uint8_t, kBlockHeaderBytes> encode_block_header(const BlockHeader& header) {
    std::array<std::uint8_t, kBlockHeaderBytes> bytes{};
    std::copy(kBlockSync.begin(), kBlockSync.end(), bytes.begin());
    store(&bytes[4], static_cast<std::uint32_t>(header.kind));
    store(&bytes[8], header.number);
    store(&bytes[12], header.record_bytes);
    store(&bytes[16], header.payload_bytes);
    store(&bytes[24], header.record_crc);
    store(&bytes[28], crc32c(std::span(bytes).first(28)));
    return bytes;
}

std::optional<BlockHeader> decode_block_header(std::span<const std::uint8_t> bytes) {
    if (!std::equal(kBlockSync.begin(), kBlockSync.end(), bytes.begin())) return std::nullopt;
    if (load<std::uint32_t>(&bytes[28]) != crc32c(bytes.first(28))) return std::nullopt;
    const auto kind = load<std::uint32_t>(&bytes[4]);
    const BlockHeader header{static_cast<BlockKind>(kind), load<std::uint32_t>(&bytes[8]),
                             load<std::uint32_t>(&bytes[12]), load<std::uint64_t>(&bytes[16]),
                             load<std::uint32_t>(&bytes[24])};
    if (header.record_bytes > kMaxTextBytes || header.payload_bytes > kMaxFramePayloadBytes)
        return std::nullopt;
    return header;
}

std::vector<std::uint8_t> encode_frame_record(const CapturedFrame& frame) {
    const FrameRecord& record = frame.record;
    const FrameLayout& layout = record.layout;
    assert(layout.format != nullptr);
    const std::size_t holes = std::min(frame.holes.size(), kMaxHoles);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(kFrameRecordBytes + holes * kHoleBytes);
    for (const std::uint64_t value :
         {record.id, record.wire_id, record.lost_before, bits_of(record.device_ns),
          bits_of(record.host_monotonic_ns), bits_of(record.host_realtime_ns)})
        append(bytes, value);
    for (const auto& value : {record.exposure_us, record.gain, record.black_level_dn})
        append(bytes, or_nan(value));
    append(bytes, std::uint64_t{record.bytes_received});
    append(bytes, record.payload_hash);
    append(bytes, std::uint64_t{layout.stride_bytes});
    append(bytes, record.epoch);
    for (const int value : {layout.offset_x, layout.offset_y, layout.width, layout.height})
        append(bytes, static_cast<std::uint32_t>(value));
    append(bytes, static_cast<std::uint32_t>(holes));
    bytes.push_back(static_cast<std::uint8_t>(record.cause));
    bytes.push_back(static_cast<std::uint8_t>(record.status));
    bytes.push_back(static_cast<std::uint8_t>(record.stamp_source));
    append_format(bytes, *layout.format);
    assert(bytes.size() == kFrameRecordBytes);
    for (std::size_t i = 0; i < holes; ++i) {
        append(bytes, std::uint64_t{frame.holes[i].first});
        append(bytes, std::uint64_t{(i + 1 < holes ? frame.holes[i] : frame.holes.back()).second});
    }
    return bytes;
}

void store_payload_hash(std::span<std::uint8_t> record, std::uint64_t hash) {
    store(&record[kPayloadHashOffset], hash);
}

std::string decode_frame_record(std::span<const std::uint8_t> bytes, std::uint64_t payload_bytes,
                                CapturedFrame& frame) {
    if (bytes.size() < kFrameRecordBytes) return "a frame record that is too short";
    Fields fields{bytes.data()};
    FrameRecord& record = frame.record;
    record.id = fields.take<std::uint64_t>();
    record.wire_id = fields.take<std::uint64_t>();
    record.lost_before = fields.take<std::uint64_t>();
    record.device_ns = fields.take_signed();
    record.host_monotonic_ns = fields.take_signed();
    record.host_realtime_ns = fields.take_signed();
    record.exposure_us = unless_nan(fields.take<double>());
    record.gain = unless_nan(fields.take<double>());
    record.black_level_dn = unless_nan(fields.take<double>());
    record.bytes_received = fields.take<std::uint64_t>();
    record.payload_hash = fields.take<std::uint64_t>();
    record.layout.stride_bytes = fields.take<std::uint64_t>();
    record.epoch = fields.take<std::uint32_t>();
    for (int* const value : {&record.layout.offset_x, &record.layout.offset_y, &record.layout.width,
                             &record.layout.height})
        *value = static_cast<int>(std::min(fields.take<std::uint32_t>(), kMaxOffset));
    const auto holes = fields.take<std::uint32_t>();
    const auto cause = fields.take<std::uint8_t>();
    const auto status = fields.take<std::uint8_t>();
    const auto stamp_source = fields.take<std::uint8_t>();
    if (cause >= kGapCauseNames.size() || status > 3 || stamp_source > 4)
        return "a cause, status or clock that is not known";
    record.cause = static_cast<GapCause>(cause);
    record.status = static_cast<FrameStatus>(status);
    record.stamp_source = static_cast<StampSource>(stamp_source);
    record.layout.format = decode_format(fields.at);
    if (std::string problem = layout_problem(record.layout); !problem.empty()) return problem;
    if (record.status == FrameStatus::kComplete && payload_bytes < record.layout.payload_bytes())
        return fmt::format("{} of the {} bytes of its layout, but is said to be complete",
                           payload_bytes, record.layout.payload_bytes());
    if (holes > kMaxHoles || bytes.size() != kFrameRecordBytes + holes * kHoleBytes)
        return "a number of holes that does not fit its length";
    return take_holes({bytes.data() + kFrameRecordBytes}, holes, payload_bytes, frame);
}

std::map<std::string, std::string> host_facts() {
    struct utsname name {};
    if (uname(&name) != 0) return {};
    return {{"kernel", std::string(name.sysname).append(" ").append(name.release)},
            {"machine", name.machine}};
}

}  // namespace stipple
