#pragma once

#include <string>

#include "apps/arguments/command_line.h"
#include "session/shard.h"

namespace stipple {

/// `--part I/N`.
void add_part(Command& command, Shard& part, const std::string& text);

/// For callbacks. \throws UsageError if `output` is no name of the folder that a part fills.
void check_part_folder(const std::string& output);

}  // namespace stipple
