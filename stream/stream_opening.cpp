#include "stream/stream_opening.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "core/memory_limit.h"
#include "stream/header_codec.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// The next `bytes` bytes, or fewer if they do not come.
Bytes peek_or_wait(BufferedReader& window, std::size_t bytes, const WaitForMore& wait) {
    Bytes there = window.peek(bytes);
    while (there.size() < bytes && wait && wait(window.bytes_read())) there = window.peek(bytes);
    return there;
}

}  // namespace

std::uint64_t bytes_of(const BufferedReader& window, const WaitForMore& wait) {
    return wait ? kEndlessInput : window.file_bytes().value_or(kEndlessInput);
}

StreamOpening open_stream_header(BufferedReader& window, const std::string& where,
                                 ReadPolicy policy, const WaitForMore& wait) {
    const std::size_t bytes = header_bytes(peek_or_wait(window, kHeaderStartBytes, wait), where);
    const Bytes header = peek_or_wait(window, bytes, wait);
    if (header.size() < bytes)
        throw InputError(fmt::format("{}: byte {}", where, header.size()),
                         fmt::format("the file ends within its header of {} bytes", bytes));
    std::optional<DueCounts> counts;
    const ScheduleUse use{policy == ReadPolicy::kCounts ? &counts : nullptr,
                          bytes_of(window, wait)};
    StreamHeader decoded = decode_header(header, where, use);
    StreamOpening result{std::move(decoded), framing_of(header), std::move(counts),
                         policy == ReadPolicy::kCounts};
    window.skip(bytes);
    return result;
}

}  // namespace stipple
