#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace stipple {

/// What distinguishes a whole stream from others, from its header and its end alone: the CRC of the
/// header and the checksum of all packets, as text. Nothing if the file has no good end, or is of
/// version 1. Damaged copies of a stream have the same. \throws InputError if it is no stream.
[[nodiscard]] std::optional<std::string> stream_identity(const std::filesystem::path& file);

/// The comment in the header of window `number` of a decoding: it has the CRC-32C of `decoding`,
/// the text of its decoding.json, so that no window of another decoding is taken for it.
[[nodiscard]] std::string window_mark(std::int64_t number, std::string_view decoding);

}  // namespace stipple
