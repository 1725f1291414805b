#pragma once

#include <optional>
#include <string>

#include "apps/arguments/run_options.h"
#include "io/raw_format.h"

namespace stipple {

/// True if `source` is footage by its kind: a folder, a pattern, or a file with the extension of an
/// image, video, array or camera file.
[[nodiscard]] bool is_footage(const std::string& source);

/// `stipple info` of footage. Reads all frames unless `header_only`. \throws InputError as
/// FootageReader, after the figures up to the fault.
void info_footage(const std::string& source, const std::optional<RawFormat>& raw, bool header_only,
                  const RunOptions& run);

}  // namespace stipple
