#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/pending_output.h"

namespace stipple {

/// Writes `text` to the file `path`, which messages call `name`. A file that cannot be completed is
/// removed. \throws DeviceError.
void write_whole(const std::filesystem::path& path, const std::string& name, std::string_view text);

/// Writes `text` to an output that is a file, and puts it in place. \throws DeviceError.
void write_text(PendingOutput& output, std::string_view text);

/// Writes `text` to `file`, which appears when it is complete. \throws InputError as PendingOutput,
/// DeviceError.
void write_text_file(const std::filesystem::path& file, bool force, std::string_view text);

}  // namespace stipple
