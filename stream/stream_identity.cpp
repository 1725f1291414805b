#include "stream/stream_reader.h"

#include <fmt/format.h>

#include <cstddef>
#include <system_error>

#include "stream/buffered_reader.h"
#include "stream/header_codec.h"
#include "stream/slot_index.h"

namespace stipple {

bool is_stream(const std::filesystem::path& path) {
    std::error_code error;  // the reader of the file says what it is
    if (!std::filesystem::is_regular_file(path, error)) return false;
    BufferedReader file(path);
    return begins_as_stream(file.peek(kHeaderStartBytes));
}

std::optional<std::string> stream_identity(const std::filesystem::path& file) {
    BufferedReader window(file);
    const std::size_t bytes = header_bytes(window.peek(kHeaderStartBytes), file.string());
    const auto header = window.peek(bytes);
    if (header.size() < bytes) return std::nullopt;
    const Framing framing = framing_of(header);
    const auto index = read_trailing_index(window, framing);
    if (!index || !index->checksum) return std::nullopt;
    return fmt::format("crc {:08x} {:08x}", framing.seed, *index->checksum);
}

}  // namespace stipple
