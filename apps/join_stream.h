#pragma once

#include <filesystem>
#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// Writes the stream of a folder of pieces: the bytes of one run of `emulate`.
/// \throws InputError if a piece is missing or damaged; DeviceError, Interrupted.
void join_stream(const std::filesystem::path& folder, const std::string& output,
                 const RunOptions& run);

}  // namespace stipple
