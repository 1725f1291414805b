#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace stipple {

/// All bytes of a file. \throws InputError if it is missing, a folder or unreadable.
[[nodiscard]] std::vector<std::uint8_t> read_file(const std::filesystem::path& file);

}  // namespace stipple
