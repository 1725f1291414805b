#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace stipple {

/// What distinguishes a whole stream from others, from its header and its end alone: the CRC of the
/// header and the checksum of all packets, as text. Nothing if the file has no good end, or is of
/// version 1. Damaged copies of a stream have the same. \throws InputError if it is no stream.
[[nodiscard]] std::optional<std::string> stream_identity(const std::filesystem::path& file);

}  // namespace stipple
