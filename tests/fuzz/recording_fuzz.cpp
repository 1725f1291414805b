#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "capture/pixel_unpack.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"
#include "tests/fuzz/memory_file.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

void require(bool property) {
    if (!property) std::abort();
}

/// Makes CRCs and hashes good, so that the fuzzer gets beyond them.
Bytes repaired(Bytes bytes) {
    const std::span<std::uint8_t> view(bytes);
    for (std::size_t at = kRecordingMagic.size(); at + kBlockHeaderBytes <= bytes.size();) {
        const auto block = view.subspan(at);
        if (!std::equal(kBlockSync.begin(), kBlockSync.end(), block.begin())) {
            ++at;
            continue;
        }
        const auto body = block.subspan(kBlockHeaderBytes);
        const std::uint64_t record = load<std::uint32_t>(&block[12]);
        const auto payload = load<std::uint64_t>(&block[16]);
        const bool whole = record <= body.size() && payload <= body.size() - record;
        if (whole && load<std::uint32_t>(&block[4]) == 2 && record >= kFrameRecordBytes)
            store_payload_hash(body.first(record), payload_hash(body.subspan(record, payload)));
        if (whole) store(&block[24], crc32c(body.first(record)));
        store(&block[28], crc32c(block.first(28)));
        at += kBlockHeaderBytes + (whole ? record + payload : 0);
    }
    return bytes;
}

/// A frame that is delivered can be used without further checks.
void check_frame(const CapturedFrame& frame) {
    const FrameLayout& layout = frame.record.layout;
    require(layout.format != nullptr && layout.width > 0 && layout.height > 0);
    require(layout.stride_bytes >= layout.format->row_bytes(layout.width));
    require(frame.record.payload_hash == payload_hash(frame.payload));
    std::size_t end = 0;
    for (const auto& hole : frame.holes) {
        require(hole.first >= end && hole.second > hole.first);
        require(hole.second <= frame.payload.size());
        end = hole.second;
    }
    if (layout.width * layout.height > 4096) return;
    std::vector<std::uint16_t> samples;
    unpack_frame(layout, frame.payload, samples);
    require(samples.size() ==
            static_cast<std::size_t>(layout.width * layout.height * layout.format->planes));
}

void read(const Bytes& bytes) {
    const MemoryFile file({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    try {
        RecordingReader reader(file.path());
        std::uint64_t frames = 0;
        std::uint64_t payload_bytes = 0;
        for (CapturedFrame frame; reader.next(frame); ++frames) {
            check_frame(frame);
            payload_bytes += frame.payload.size();
        }
        require(reader.report().frames == frames);
        require(payload_bytes <= bytes.size());
        std::uint64_t skipped = 0;
        for (const RecordingDamage& damage : reader.report().damage) skipped += damage.bytes;
        require(skipped <= bytes.size());
        if (bytes.size() > 16) static_cast<void>(encode_session(reader.session()));
        if (reader.end()) static_cast<void>(encode_end(*reader.end()));
    } catch (const InputError&) {
        return;
    }
}

}  // namespace
}  // namespace stipple

/// Input: a recording; it is read as it is, and with all CRCs and hashes made good.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const Bytes bytes(data, data + size);
    read(bytes);
    read(repaired(bytes));
    return 0;
}
