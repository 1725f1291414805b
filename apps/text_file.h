#pragma once

#include <filesystem>
#include <string_view>

namespace stipple {

/// Writes `text` to `file`, which appears when it is complete. \throws InputError as PendingOutput,
/// DeviceError.
void write_text_file(const std::filesystem::path& file, bool force, std::string_view text);

}  // namespace stipple
