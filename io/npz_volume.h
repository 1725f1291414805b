#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/npy_file.h"

namespace stipple {

/// Whether a file has the extension .npz.
[[nodiscard]] bool is_npz(const std::filesystem::path& file);

/// The array `name` of a .npz, a ZIP archive of .npy files that may be compressed (numpy.savez,
/// numpy.savez_compressed). \throws InputError at `where` if it is none or damaged, or lacks the
/// array; as parse_npy_volume; as check_memory.
[[nodiscard]] NpyVolume parse_npz_volume(std::span<const std::uint8_t> bytes,
                                         const std::string& where, std::string_view name,
                                         NpyImages images = NpyImages::kRefused);

/// \throws InputError as above, or if the file cannot be read.
[[nodiscard]] NpyVolume read_npz_volume(const std::filesystem::path& file, std::string_view name,
                                        NpyImages images = NpyImages::kRefused);

}  // namespace stipple
