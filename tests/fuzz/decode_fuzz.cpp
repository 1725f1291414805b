#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/decode_options.h"
#include "decoder/reconstruct.h"
#include "stream/stream_reader.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/stream_pieces.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

constexpr std::size_t kMaxSites = 1024;
constexpr int kMaxPeriod = 32;
constexpr std::int64_t kMaxSlots = 48;

DecodeOptions short_options(DecodeMethod method) {
    DecodeOptions options{.method = method};
    options.fast.static_tv.iterations = 2;
    options.fast.along_motion.iterations = 1;
    options.fast.rounds = 1;
    options.fast.last_iterations = 2;
    options.fast.mosaic.last_iterations = 2;
    return options;
}

/// Light is a number, not negative, and comes slot after slot, whatever the samples are.
void decode_by(DecodeMethod method, const std::string& file) {
    try {
        StreamReader reader(file);
        const StreamHeader& header = reader.header();
        if (header.shape.sites() > kMaxSites || header.schedule.period_slots() > kMaxPeriod) return;
        std::int64_t next = 0;
        decode(reader, short_options(method), [&](std::int64_t slot, std::span<const float> frame) {
            require(slot == next++);
            require(std::ranges::all_of(
                frame, [](float light) { return std::isfinite(light) && light >= 0; }));
            return next < kMaxSlots;
        });
    } catch (const InputError&) {
    }
}

}  // namespace
}  // namespace stipple

/// Input: a stream; it is decoded as it is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::span<const std::uint8_t> bytes(data, size);
    if (size < kStreamHeadBytes || asks_for_much(bytes)) return 0;
    const ThreadLimit one(1);
    const MemoryFile file(bytes);
    decode_by(DecodeMethod::kNaive, file.path());
    decode_by(DecodeMethod::kFast, file.path());
    return 0;
}
