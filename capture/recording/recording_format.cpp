#include "capture/recording/recording_format.h"

#include <fmt/format.h>
#include <sys/utsname.h>

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

/// A pixel format in a frame record.
struct StoredFormat {
    std::uint8_t packing = 0;
    std::uint8_t filter = 0;
    std::uint8_t planes = 0;
    std::uint8_t bits_per_pixel = 0;
    std::uint8_t significant_bits = 0;
    std::array<char, 32> name{};  ///< padded with zeros

    friend bool operator==(const StoredFormat&, const StoredFormat&) = default;
};

/// The content of a frame record. `format` stands for the pointer in the layout.
struct StoredFrame {
    FrameRecord record;
    std::uint32_t holes = 0;
    StoredFormat format;
};

/// The layout of the frame record: calls visit(name, type, value) for each field, in the order of
/// the bytes. There are no gaps between fields. Writer, reader and `frame_record_fields` use it.
template <typename Frame, typename Visit>
constexpr void visit_fields(Frame& frame, Visit visit) {
    auto& [record, holes, format] = frame;
    visit("id", "<u8", record.id);
    visit("wire_id", "<u8", record.wire_id);
    visit("lost_before", "<u8", record.lost_before);
    visit("device_ns", "<i8", record.device_ns);
    visit("host_monotonic_ns", "<i8", record.host_monotonic_ns);
    visit("host_realtime_ns", "<i8", record.host_realtime_ns);
    visit("exposure_us", "<f8", record.exposure_us);
    visit("gain", "<f8", record.gain);
    visit("black_level_dn", "<f8", record.black_level_dn);
    visit("bytes_received", "<u8", record.bytes_received);
    visit("payload_hash", "<u8", record.payload_hash);
    visit("stride_bytes", "<u8", record.layout.stride_bytes);
    visit("epoch", "<u4", record.epoch);
    visit("offset_x", "<u4", record.layout.offset_x);
    visit("offset_y", "<u4", record.layout.offset_y);
    visit("width", "<u4", record.layout.width);
    visit("height", "<u4", record.layout.height);
    visit("holes", "<u4", holes);
    visit("cause", "u1", record.cause);
    visit("status", "u1", record.status);
    visit("stamp_source", "u1", record.stamp_source);
    visit("packing", "u1", format.packing);
    visit("filter", "u1", format.filter);
    visit("planes", "u1", format.planes);
    visit("bits_per_pixel", "u1", format.bits_per_pixel);
    visit("significant_bits", "u1", format.significant_bits);
    visit("format", "S32", format.name);
}

/// A value is stored as it lies in memory (little-endian), an optional number as NaN if it is
/// empty.
template <typename T>
constexpr std::size_t kStoredBytes = sizeof(T);
template <>
constexpr std::size_t kStoredBytes<std::optional<double>> = sizeof(double);

template <typename T>
void store_value(std::uint8_t* bytes, const T& value) {
    std::memcpy(bytes, &value, sizeof(T));
}
void store_value(std::uint8_t* bytes, const std::optional<double>& value) {
    store(bytes, value.value_or(std::numeric_limits<double>::quiet_NaN()));
}

template <typename T>
void load_value(const std::uint8_t* bytes, T& value) {
    std::memcpy(&value, bytes, sizeof(T));
}
void load_value(const std::uint8_t* bytes, std::optional<double>& value) {
    const auto number = load<double>(bytes);
    value = std::isnan(number) ? std::nullopt : std::optional(number);
}

constexpr StoredFrame kNoFrame{};

constexpr std::size_t kFieldCount = [] {
    std::size_t count = 0;
    visit_fields(kNoFrame, [&](auto, auto, const auto&) { ++count; });
    return count;
}();

constexpr auto kFields = [] {
    std::array<RecordField, kFieldCount> fields{};
    std::size_t count = 0;
    std::size_t offset = 0;
    visit_fields(kNoFrame, [&]<typename T>(auto name, auto type, const T&) {
        fields[count++] = {name, type, offset};
        offset += kStoredBytes<T>;
    });
    return fields;
}();
static_assert(kFields.back().offset + sizeof(StoredFormat::name) == kFrameRecordBytes);

/// Of a type in the notation of NumPy.
constexpr std::size_t width_of(std::string_view type) {
    std::size_t width = 0;
    for (const char c : type)
        if (c >= '0' && c <= '9') width = 10 * width + static_cast<std::size_t>(c - '0');
    return width;
}
static_assert([] {
    bool agree = true;
    visit_fields(kNoFrame, [&]<typename T>(auto, auto type, const T&) {
        agree = agree && width_of(type) == kStoredBytes<T>;
    });
    return agree;
}());

constexpr std::size_t offset_of(std::string_view field) {
    return std::ranges::find(kFields, field, &RecordField::name)->offset;
}

StoredFormat stored(const PixelFormat& format) {
    StoredFormat result{.packing = static_cast<std::uint8_t>(format.packing),
                        .filter = static_cast<std::uint8_t>(format.filter),
                        .planes = static_cast<std::uint8_t>(format.planes),
                        .bits_per_pixel = static_cast<std::uint8_t>(format.bits_per_pixel),
                        .significant_bits = static_cast<std::uint8_t>(format.significant_bits)};
    assert(format.name.size() < result.name.size());
    std::ranges::copy(format.name, result.name.begin());
    return result;
}

/// nullptr if it is none of ours.
const PixelFormat* format_of(const StoredFormat& format) {
    const std::size_t length = strnlen(format.name.data(), format.name.size());
    const PixelFormat* named = pixel_format_named({format.name.data(), length});
    return named != nullptr && stored(*named) == format ? named : nullptr;
}

bool has_known_codes(const FrameRecord& record) {
    return static_cast<std::size_t>(record.cause) < kGapCauses.size() &&
           record.status <= FrameStatus::kDeviceError &&
           record.stamp_source <= StampSource::kUnnamedClock;
}

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

std::string take_holes(std::span<const std::uint8_t> bytes, std::uint64_t payload_bytes,
                       CapturedFrame& frame) {
    frame.holes.clear();
    std::uint64_t previous_end = 0;
    for (; !bytes.empty(); bytes = bytes.subspan(kHoleBytes)) {
        const auto begin = load<std::uint64_t>(&bytes[0]);
        const auto end = load<std::uint64_t>(&bytes[8]);
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
    assert(frame.record.layout.format != nullptr);
    const std::size_t holes = std::min(frame.holes.size(), kMaxHoles);
    const StoredFrame content{frame.record, static_cast<std::uint32_t>(holes),
                              stored(*frame.record.layout.format)};
    std::vector<std::uint8_t> bytes(kFrameRecordBytes);
    bytes.reserve(kFrameRecordBytes + holes * kHoleBytes);
    std::uint8_t* at = bytes.data();
    visit_fields(content, [&]<typename T>(auto, auto, const T& value) {
        store_value(at, value);
        at += kStoredBytes<T>;
    });
    for (std::size_t i = 0; i < holes; ++i) {
        append(bytes, std::uint64_t{frame.holes[i].first});
        append(bytes, std::uint64_t{(i + 1 < holes ? frame.holes[i] : frame.holes.back()).second});
    }
    return bytes;
}

void store_payload_hash(std::span<std::uint8_t> record, std::uint64_t hash) {
    store(&record[offset_of("payload_hash")], hash);
}

std::string decode_frame_record(std::span<const std::uint8_t> bytes, std::uint64_t payload_bytes,
                                CapturedFrame& frame) {
    if (bytes.size() < kFrameRecordBytes) return "a frame record that is too short";
    StoredFrame content;
    const std::uint8_t* at = bytes.data();
    visit_fields(content, [&]<typename T>(auto, auto, T& value) {
        load_value(at, value);
        at += kStoredBytes<T>;
    });
    FrameRecord& record = content.record;
    FrameLayout& layout = record.layout;
    for (int* const offset : {&layout.offset_x, &layout.offset_y})
        if (*offset < 0) *offset = std::numeric_limits<int>::max();  // 2^31 and more in the file
    if (!has_known_codes(record)) return "a cause, status or clock that is not known";
    layout.format = format_of(content.format);
    if (std::string problem = layout_problem(layout); !problem.empty()) return problem;
    if (record.status == FrameStatus::kComplete && payload_bytes < layout.payload_bytes())
        return fmt::format("{} of the {} bytes of its layout, but is said to be complete",
                           payload_bytes, layout.payload_bytes());
    const auto holes = bytes.subspan(kFrameRecordBytes);
    if (content.holes > kMaxHoles || holes.size() != content.holes * kHoleBytes)
        return "a number of holes that does not fit its length";
    frame.record = record;
    return take_holes(holes, payload_bytes, frame);
}

std::map<std::string, std::string> host_facts() {
    struct utsname name {};
    if (uname(&name) != 0) return {};
    return {{"kernel", std::string(name.sysname).append(" ").append(name.release)},
            {"machine", name.machine}};
}

}  // namespace stipple
