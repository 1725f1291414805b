#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace stipple {

/// All bytes of a file or pipe. \throws InputError if it is missing, a folder, a device or
/// unreadable.
[[nodiscard]] std::vector<std::uint8_t> read_file(const std::filesystem::path& file);

/// \throws InputError for a device, pipe or socket, which may be endless and cannot seek.
void refuse_special(const std::filesystem::path& file);

}  // namespace stipple
