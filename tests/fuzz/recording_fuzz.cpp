#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/frame_light.h"
#include "capture/frame_payload.h"
#include "capture/recording/recording_footage.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "tests/fuzz/require.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

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

void read(std::span<const std::uint8_t> bytes, const std::string& file) {
    try {
        RecordingReader reader(file);
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

/// As `emulate` reads it: what is light is a number and not negative.
void read_footage(const std::string& file) {
    constexpr std::size_t kMaxSites = 1 << 16;
    constexpr int kMaxSlots = 64;
    try {
        RecordingFootage footage(file);
        if (footage.shape().sites() > kMaxSites) return;
        std::vector<float> light(footage.shape().sites());
        for (int slot = 0; slot < kMaxSlots && footage.read(light); ++slot)
            require(std::ranges::all_of(light, [](float value) { return value >= 0; }));
    } catch (const InputError&) {
        return;
    }
}

}  // namespace
}  // namespace stipple

/// Input: a recording.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::span<const std::uint8_t> bytes(data, size);
    const MemoryFile file(bytes);
    read(bytes, file.path());
    read_footage(file.path());
    return 0;
}
