#include "stream/header_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/geometry.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'S', 'T', 'P', 'L', '\r', '\n', 0x1A};
constexpr std::array<std::uint8_t, 4> kRecording{0x89, 'S', 'T', 'R'};  // recording_format.md
constexpr std::uint16_t kVersion = 2;        ///< that is written; 1 is read, too
constexpr std::uint16_t kWeightVersion = 3;  ///< the same, if bytes 86 and 87 are not both 0
constexpr std::uint16_t kSwitchVersion = 4;  ///< the same, if the schedule may change
constexpr std::size_t kVersionAt = 8;
constexpr std::size_t kFixedBytes = 92;
constexpr std::size_t kCrcBytes = 4;
constexpr std::size_t kMaxProvenanceBytes = std::size_t{1} << 20U;
constexpr std::size_t kMinHeaderBytes = kFixedBytes + 1 + kCrcBytes;  ///< a schedule of a byte
constexpr std::size_t kMaxScheduleBytes = std::size_t{1} << 28U;
constexpr std::size_t kMaxCalibrationBytes = 12 + 16 * kMaxCalibrationPixels;
constexpr std::size_t kMaxHeaderBytes = kFixedBytes + kMaxNameBytes + kMaxProvenanceBytes +
                                        kMaxScheduleBytes + kMaxCalibrationBytes +
                                        sizeof(float) * kMaxWeights + kCrcBytes;

[[noreturn]] void fail_at(std::string_view where, std::size_t offset, std::string_view problem) {
    throw InputError(fmt::format("{}: byte {}", where, offset), problem);
}

/// A number of the header and the values it may have.
struct Field {
    std::size_t offset;
    const char* name;
    double min;
    double max;
};

constexpr Field kHeaderLength{12, "header bytes", kMinHeaderBytes, kMaxHeaderBytes};
constexpr Field kRows{16, "rows", 1, kMaxFrameSide};
constexpr Field kCols{18, "columns", 1, kMaxFrameSide};
constexpr Field kPlanes{20, "planes", 1, 4};
constexpr Field kSites{16, "rows x columns x planes", 1, kMaxFrameSites};
constexpr Field kColourFilter{21, "colour filter array", 0, 4};
constexpr Field kBitDepth{22, "bit depth", 1, 16};
constexpr Field kRounding{23, "rounding", 0, 1};
constexpr Field kSlotDuration{24, "slot duration in us", 1e-12, 1e12};
constexpr Field kBlackLevel{32, "black level in DN", 0, 65535};
constexpr Field kGain{40, "gain in electrons per DN", 1e-12, 1e12};
constexpr Field kReadNoise{48, "read noise in electrons", 0, 1e12};
constexpr Field kFullWell{56, "full well in electrons", 1e-12, 1e12};
constexpr Field kElectronsPerUnit{64, "electrons of flux 1.0 in a slot", 1e-12, 1e12};
constexpr Field kNameBytes{72, "bytes of the schedule name", 0, kMaxNameBytes};
constexpr Field kProvenanceBytes{76, "bytes of the provenance text", 0, kMaxProvenanceBytes};
constexpr Field kScheduleBytes{80, "bytes of the schedule section", 1, kMaxScheduleBytes};
constexpr Field kScheduleKind{84, "schedule kind", 0, 1};
constexpr Field kCalibrationSection{85, "calibration section", 0, 1};
constexpr Field kWeightSection{86, "weights section", 0, 1};
constexpr Field kNoiseFree{87, "absence of noise", 0, 1};
constexpr std::size_t kScheduleCrc = 88;
constexpr std::size_t kReserved = 10;  ///< two bytes

std::optional<std::string> fault_of(const Field& field, double value) {
    if (value >= field.min && value <= field.max) return std::nullopt;  // false for NaN
    return fmt::format("{} {:.12g} is outside {:.12g}..{:.12g}", field.name, value, field.min,
                       field.max);
}

void check(const Field& field, double value, std::string_view where) {
    if (const auto fault = fault_of(field, value)) fail_at(where, field.offset, *fault);
}

/// The part of a header that is numbers.
struct Numbers {
    FrameShape shape;
    double slot_us = 0;
    Calibration calibration;
    ColourFilter cfa = ColourFilter::kNone;
};

void check(const Numbers& numbers, std::string_view where) {
    const auto& [shape, slot_us, calibration, cfa] = numbers;
    check(kRows, shape.rows, where);
    check(kCols, shape.cols, where);
    check(kPlanes, shape.planes, where);
    check(kSites, static_cast<double>(shape.sites()), where);
    check(kColourFilter, static_cast<int>(cfa), where);
    if (cfa != ColourFilter::kNone && shape.planes != 1)
        fail_at(where, kColourFilter.offset,
                fmt::format("a colour filter array has one plane, not {}", shape.planes));
    check(kBitDepth, calibration.bit_depth, where);
    check(kRounding, static_cast<int>(calibration.rounding), where);
    check(kSlotDuration, slot_us, where);
    check(kBlackLevel, calibration.black_level_dn, where);
    check(kGain, calibration.gain_e_per_dn, where);
    check(kReadNoise, calibration.read_noise_e, where);
    check(kFullWell, calibration.full_well_e, where);
    check(kElectronsPerUnit, calibration.electrons_per_unit, where);
}

void check_texts(std::string_view name, std::string_view provenance, std::string_view where) {
    check(kNameBytes, static_cast<double>(name.size()), where);
    check(kProvenanceBytes, static_cast<double>(provenance.size()), where);
    if (!is_plain_text(name, false))
        fail_at(where, kFixedBytes, "schedule name is not UTF-8 without control characters");
    if (!is_plain_text(provenance, true))
        fail_at(where, kFixedBytes + name.size(),
                "provenance text is not UTF-8 without control characters");
}

template <Stored T>
T load_at(Bytes header, const Field& field) {
    return load<T>(&header[field.offset]);
}

Numbers load_numbers(Bytes header) {
    Numbers numbers;
    numbers.shape = {load_at<std::uint16_t>(header, kRows), load_at<std::uint16_t>(header, kCols),
                     load_at<std::uint8_t>(header, kPlanes)};
    numbers.slot_us = load_at<double>(header, kSlotDuration);
    numbers.cfa = static_cast<ColourFilter>(load_at<std::uint8_t>(header, kColourFilter));
    Calibration& calibration = numbers.calibration;
    calibration.bit_depth = load_at<std::uint8_t>(header, kBitDepth);
    calibration.rounding = static_cast<Rounding>(load_at<std::uint8_t>(header, kRounding));
    calibration.black_level_dn = load_at<double>(header, kBlackLevel);
    calibration.gain_e_per_dn = load_at<double>(header, kGain);
    calibration.read_noise_e = load_at<double>(header, kReadNoise);
    calibration.full_well_e = load_at<double>(header, kFullWell);
    calibration.electrons_per_unit = load_at<double>(header, kElectronsPerUnit);
    return numbers;
}

/// Appends bytes 16..71.
void append_numbers(std::vector<std::uint8_t>& bytes, const Numbers& numbers) {
    const auto& [shape, slot_us, calibration, cfa] = numbers;
    append(bytes, static_cast<std::uint16_t>(shape.rows));
    append(bytes, static_cast<std::uint16_t>(shape.cols));
    append(bytes, static_cast<std::uint8_t>(shape.planes));
    append(bytes, static_cast<std::uint8_t>(cfa));
    append(bytes, static_cast<std::uint8_t>(calibration.bit_depth));
    append(bytes, static_cast<std::uint8_t>(calibration.rounding));
    for (const double value :
         {slot_us, calibration.black_level_dn, calibration.gain_e_per_dn, calibration.read_noise_e,
          calibration.full_well_e, calibration.electrons_per_unit})
        append(bytes, value);
}

void check_reserved(Bytes header, std::string_view where) {
    const auto require_zero = [&](std::size_t at) {
        if (header[at] != 0) fail_at(where, at, "reserved byte is not zero");
    };
    for (const std::size_t at : {kReserved, kReserved + 1}) require_zero(at);
    if (load<std::uint16_t>(&header[kVersionAt]) < kWeightVersion)
        for (const Field& field : {kWeightSection, kNoiseFree}) require_zero(field.offset);
}

/// Of versions 3 and 4: bytes 86 and 87.
struct Additions {
    bool weights = false;
    bool noise_free = false;
};

Additions load_additions(Bytes header, std::string_view where) {
    for (const Field& field : {kWeightSection, kNoiseFree})
        check(field, load_at<std::uint8_t>(header, field), where);
    const Additions additions{header[kWeightSection.offset] != 0, header[kNoiseFree.offset] != 0};
    const auto version = load<std::uint16_t>(&header[kVersionAt]);
    if (version == kWeightVersion && !additions.weights && !additions.noise_free)
        fail_at(where, kVersionAt, "version 3 has weights or says that there is no noise");
    if (version == kSwitchVersion && additions.weights)
        fail_at(where, kWeightSection.offset, "version 4 has no weights");
    if (additions.weights && load_at<std::uint8_t>(header, kScheduleKind) != 0)
        fail_at(where, kWeightSection.offset, "a random schedule has no weights");
    return additions;
}

/// The parts after the fixed one.
struct Parts {
    std::string_view name;
    std::string_view provenance;
    Bytes schedule;
    Bytes sections;  ///< calibration and weights, if they are present
};

Parts split(Bytes header, std::string_view where) {
    std::size_t at = kFixedBytes;
    const auto part = [&](const Field& length) {
        const auto bytes = load_at<std::uint32_t>(header, length);
        check(length, bytes, where);
        if (bytes > header.size() - kCrcBytes - at)
            fail_at(where, length.offset,
                    fmt::format("{} {} exceeds the header", length.name, bytes));
        at += bytes;
        return header.subspan(at - bytes, bytes);
    };
    const auto text = [](Bytes bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::string_view name = text(part(kNameBytes));
    const std::string_view provenance = text(part(kProvenanceBytes));
    const Bytes schedule = part(kScheduleBytes);
    return {name, provenance, schedule, header.subspan(at, header.size() - kCrcBytes - at)};
}

/// Of the sections after the schedule, the bytes of the calibration; the rest are weights.
std::size_t calibration_bytes(Bytes header, std::size_t sections, std::size_t weights,
                              std::string_view where) {
    const bool calibrated = load_at<std::uint8_t>(header, kCalibrationSection) != 0;
    if (weights > sections || (weights == sections) == calibrated)
        fail_at(where, kHeaderLength.offset, "header bytes are not the sum of its parts");
    return sections - weights;
}

void refuse_interleaved(const ExposureSchedule& schedule, std::string_view where) {
    if (schedule.interleaved())
        fail_at(where, kVersionAt, "version 4 has no interleaved exposures");
}

}  // namespace

std::optional<std::string> readout_fault(const ReadoutValues& values) {
    const std::pair<Field, double> fields[] = {{kRounding, static_cast<int>(values.rounding)},
                                               {kBlackLevel, values.black_level_dn},
                                               {kGain, values.gain_e_per_dn},
                                               {kReadNoise, values.read_noise_e},
                                               {kFullWell, values.full_well_e},
                                               {kElectronsPerUnit, values.electrons_per_unit}};
    for (const auto& [field, value] : fields)
        if (auto fault = fault_of(field, value)) return fault;
    return std::nullopt;
}

std::optional<std::string> name_fault(std::string_view name) {
    if (auto fault = fault_of(kNameBytes, static_cast<double>(name.size()))) return fault;
    if (is_plain_text(name, false)) return std::nullopt;
    return "schedule name is not UTF-8 without control characters";
}

std::vector<std::uint8_t> encode_header(const StreamHeader& header, std::string_view where) {
    const Numbers numbers{header.shape, header.slot_us, header.calibration, header.cfa};
    check(numbers, where);
    check_texts(header.schedule_name, header.provenance, where);
    const auto schedule = encode_schedule(header, where);
    check(kScheduleBytes, static_cast<double>(schedule.size()), where);
    const bool calibrated = needs_calibration_section(header.calibration);
    const auto calibration =
        calibrated ? encode_calibration(header.calibration, where) : std::vector<std::uint8_t>{};
    const bool weighted = header.schedule.weighted();
    if (weighted && header.schedule_source.kind == ScheduleSource::Kind::kRandom)
        fail_at(where, kWeightSection.offset, "a random schedule has no weights");
    const auto weights =
        weighted ? encode_weights(header.schedule, where) : std::vector<std::uint8_t>{};
    const bool noise_free = header.calibration.noise_free;

    std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
    if (header.may_switch) refuse_interleaved(header.schedule, where);
    if (header.may_switch && weighted)
        fail_at(where, kWeightSection.offset, "version 4 has no weights");
    append(bytes, header.may_switch        ? kSwitchVersion
                  : weighted || noise_free ? kWeightVersion
                                           : kVersion);
    append(bytes, std::uint16_t{0});
    append(bytes, static_cast<std::uint32_t>(kFixedBytes + header.schedule_name.size() +
                                             header.provenance.size() + schedule.size() +
                                             calibration.size() + weights.size() + kCrcBytes));
    append_numbers(bytes, numbers);
    append(bytes, static_cast<std::uint32_t>(header.schedule_name.size()));
    append(bytes, static_cast<std::uint32_t>(header.provenance.size()));
    append(bytes, static_cast<std::uint32_t>(schedule.size()));
    append(bytes, static_cast<std::uint8_t>(header.schedule_source.kind));
    for (const bool flag : {calibrated, weighted, noise_free})
        append(bytes, static_cast<std::uint8_t>(flag ? 1 : 0));
    append(bytes, schedule_crc(header.schedule));
    bytes.insert(bytes.end(), header.schedule_name.begin(), header.schedule_name.end());
    bytes.insert(bytes.end(), header.provenance.begin(), header.provenance.end());
    bytes.insert(bytes.end(), schedule.begin(), schedule.end());
    bytes.insert(bytes.end(), calibration.begin(), calibration.end());
    bytes.insert(bytes.end(), weights.begin(), weights.end());
    append(bytes, crc32c(bytes));
    return bytes;
}

bool begins_as_stream(Bytes start) {
    return start.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), start.begin());
}

std::size_t header_bytes(Bytes start, std::string_view where) {
    const auto magic = start.first(std::min(start.size(), kMagic.size()));
    if (start.empty()) fail_at(where, 0, "the file is empty");
    if (!std::equal(magic.begin(), magic.end(), kMagic.begin())) {
        const bool ours = start.size() > 4 && std::equal(&kMagic[1], &kMagic[5], &start[1]);
        if (ours)
            fail_at(where, 0,
                    "this sample stream was changed by a text-mode transfer; copy it as binary");
        fail_at(
            where, 0,
            std::ranges::equal(magic.first(std::min(magic.size(), kRecording.size())), kRecording)
                ? "this is the recording of a camera; \"stipple capture replay\" reads it"
                : "this is not a sample stream (.stipple)");
    }
    if (start.size() < kHeaderStartBytes)
        fail_at(where, start.size(), "the file ends within its header");
    const auto version = load<std::uint16_t>(&start[kVersionAt]);
    if (version < 1 || version > kSwitchVersion)
        fail_at(where, kVersionAt,
                fmt::format("version {} of the sample stream; this program reads versions 1 to {}",
                            version, kSwitchVersion));
    const auto bytes = load_at<std::uint32_t>(start, kHeaderLength);
    check(kHeaderLength, bytes, where);
    return bytes;
}

Framing framing_of(Bytes header) {
    const int version = load<std::uint16_t>(&header[kVersionAt]);
    const auto crc = load<std::uint32_t>(&header[header.size() - kCrcBytes]);
    return {version, version == 1 ? 0 : crc};
}

StreamHeader decode_header(Bytes header, std::string_view where, const ScheduleUse& use) {
    const std::size_t crc_offset = header.size() - kCrcBytes;
    if (crc32c(header.first(crc_offset)) != load<std::uint32_t>(&header[crc_offset]))
        fail_at(where, crc_offset, "the header is damaged (CRC mismatch); get another copy");
    check_reserved(header, where);
    Numbers numbers = load_numbers(header);
    check(numbers, where);
    check(kCalibrationSection, load_at<std::uint8_t>(header, kCalibrationSection), where);
    const auto kind = load_at<std::uint8_t>(header, kScheduleKind);
    check(kScheduleKind, kind, where);
    const Additions additions = load_additions(header, where);
    const Parts parts = split(header, where);
    const std::size_t sections_at = crc_offset - parts.sections.size();
    if (!additions.weights)
        static_cast<void>(calibration_bytes(header, parts.sections.size(), 0, where));
    check_texts(parts.name, parts.provenance, where);
    const std::size_t schedule_at = sections_at - parts.schedule.size();
    auto stored = decode_schedule({ScheduleSource::Kind{kind}, parts.schedule, schedule_at},
                                  numbers.shape, where, use);
    if (stored.crc != load<std::uint32_t>(&header[kScheduleCrc]))
        fail_at(where, kScheduleCrc, "the schedule is not the one that was recorded");
    const bool may_switch = load<std::uint16_t>(&header[kVersionAt]) == kSwitchVersion;
    if (may_switch) refuse_interleaved(stored.schedule, where);
    const std::size_t calibration =
        calibration_bytes(header, parts.sections.size(),
                          additions.weights ? weight_bytes(stored.schedule) : 0, where);
    if (calibration > 0)
        decode_calibration(parts.sections.first(calibration), sections_at, where,
                           numbers.calibration);
    if (additions.weights)
        decode_weights(parts.sections.subspan(calibration), sections_at + calibration, where,
                       stored.schedule);
    numbers.calibration.noise_free = additions.noise_free;
    return {numbers.shape,
            numbers.slot_us,
            std::move(numbers.calibration),
            std::move(stored.schedule),
            std::move(stored.source),
            std::string(parts.name),
            std::string(parts.provenance),
            numbers.cfa,
            {},
            {},
            may_switch};
}

}  // namespace stipple
