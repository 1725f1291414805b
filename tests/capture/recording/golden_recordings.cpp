#include "tests/capture/recording/golden_recordings.h"

#include <algorithm>
#include <span>

#include "stream/crc32c.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/byte_edits.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// The bytes of a recording, and where its blocks begin: session, frames, end, end of the file.
struct RecordingBytes {
    std::string bytes;
    std::vector<std::size_t> begins{kRecordingMagic.size()};

    [[nodiscard]] std::string block(std::size_t i) const {
        return bytes.substr(begins[i], begins[i + 1] - begins[i]);
    }
};

RecordingBytes bytes_of(const std::vector<CapturedFrame>& frames) {
    const TemporaryFolder folder;
    RecordingBytes result;
    RecordingWriter writer(folder / "clip.strec", test_session());
    for (const CapturedFrame& frame : frames) {
        result.begins.push_back(writer.bytes_written());
        writer.write(frame);
    }
    result.begins.push_back(writer.bytes_written());
    writer.finish({});
    result.bytes = read_text(folder / "clip.strec");
    result.begins.push_back(result.bytes.size());
    return result;
}

/// Two frames of a format. The width leaves the last group or byte of a row incomplete.
GoldenCase of_format(const char* name, const char* format, int width = 7) {
    return {name,
            bytes_of({test_frame(0, format, width, 3), test_frame(1, format, width, 3)}).bytes};
}

/// Rows of 20 bytes for 14 that are used; the last row lacks its padding.
std::string padded_rows() {
    CapturedFrame frame = test_frame(0, "Mono16", 10, 3);
    frame.record.layout.width = 7;
    frame.payload.resize(frame.record.layout.payload_bytes());
    return bytes_of({frame}).bytes;
}

/// Losses, an incomplete frame with two holes, one that is cut, and a later epoch.
std::string losses() {
    std::vector<CapturedFrame> frames;
    for (const std::uint64_t id : {0U, 3U, 4U, 5U}) frames.push_back(test_frame(id, "Mono8", 8, 4));
    frames[1].record.lost_before = 2;
    frames[1].record.cause = GapCause::kTransport;
    frames[1].record.status = FrameStatus::kMissingPackets;
    frames[1].holes = {{3, 9}, {20, 32}};
    for (const auto& [begin, end] : frames[1].holes)
        std::fill(frames[1].payload.begin() + static_cast<std::ptrdiff_t>(begin),
                  frames[1].payload.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
    frames[2].record.status = FrameStatus::kSizeMismatch;
    frames[2].payload.resize(21);
    frames[2].record.bytes_received = 21;
    frames[3].record.epoch = 1;
    frames[3].record.exposure_us = 2500.5;
    frames[3].record.black_level_dn = 4.0;
    return bytes_of(frames).bytes;
}

std::vector<GoldenCase> features() {
    return {of_format("mono8", "Mono8"),
            of_format("mono12", "Mono12"),
            of_format("mono16_big_endian", "Mono16BE"),
            of_format("mono10p", "Mono10p", 8),
            of_format("bayer12p", "BayerRG12p", 8),
            of_format("mono14p", "Mono14p", 8),
            of_format("mono10_packed", "Mono10Packed"),
            of_format("bayer12_packed", "BayerGB12Packed"),
            of_format("mono10_mipi", "Mono10MIPI"),
            of_format("bayer12_mipi", "BayerGR12MIPI"),
            of_format("bayer14_mipi", "BayerBG14MIPI"),
            of_format("rgb8", "RGB8", 3),
            {"padded_rows", padded_rows()},
            {"losses", losses()},
            {"no_frames", bytes_of({}).bytes}};
}

/// A good block, whatever its fields say.
std::string block_of(std::uint32_t kind, std::uint32_t number, const std::string& record) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(record.data()), record.size());
    const auto header =
        encode_block_header({static_cast<BlockKind>(kind), number,
                             static_cast<std::uint32_t>(record.size()), 0, crc32c(bytes)});
    return std::string(header.begin(), header.end()) + record;
}

/// Three small frames with something done to them.
std::vector<GoldenCase> damages() {
    const RecordingBytes whole = bytes_of(
        {test_frame(0, "Mono8", 6, 2), test_frame(1, "Mono8", 6, 2), test_frame(2, "Mono8", 6, 2)});
    const auto& begins = whole.begins;
    const auto with = [&](std::size_t at, const std::string& more) {
        std::string bytes = whole.bytes;
        return bytes.insert(at, more);
    };
    const std::size_t record = begins[2] + kBlockHeaderBytes;
    return {{"cut_off", whole.bytes.substr(0, begins[4])},
            {"cut_in_frame", whole.bytes.substr(0, begins[4] - 1)},
            {"cut_in_block_header", whole.bytes.substr(0, begins[3] + 10)},
            {"cut_in_session", whole.bytes.substr(0, begins[1] - 1)},
            {"cut_in_magic", whole.bytes.substr(0, 10)},
            {"other_version", flipped(whole.bytes, 8)},
            {"reserved_in_magic", flipped(whole.bytes, 12)},
            {"damaged_session", flipped(whole.bytes, begins[0] + 100)},
            {"damaged_block_header", flipped(whole.bytes, begins[2] + 8)},
            {"damaged_record", flipped(whole.bytes, record + 24)},
            {"damaged_payload", flipped(whole.bytes, record + kFrameRecordBytes)},
            {"damaged_end", flipped(whole.bytes, begins[4] + kBlockHeaderBytes)},
            {"missing_frame", without(whole.bytes, begins[2], begins[3])},
            {"missing_bytes", without(whole.bytes, record + 100, record + 160)},
            {"missing_end_of_last_block", without(whole.bytes, begins[3] + 50, begins[4] + 10)},
            {"frame_twice", with(begins[3], whole.block(2))},
            {"frame_after_end", with(whole.bytes.size(), whole.block(3))},
            {"unknown_kind", whole.bytes.substr(0, begins[2]) + block_of(9, 2, "new") +
                                 whole.bytes.substr(begins[3])},
            {"bytes_after_end", whole.bytes + "more"},
            {"bytes_between", with(begins[2], "more")}};
}

}  // namespace

std::vector<GoldenCase> golden_recordings() {
    std::vector<GoldenCase> cases = features();
    for (GoldenCase& damage : damages()) cases.push_back(std::move(damage));
    return cases;
}

}  // namespace stipple
