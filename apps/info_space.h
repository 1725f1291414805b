#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// `stipple info` of a space of `stipple explore`, a file or a name of config/spaces. \throws
/// InputError as parse_space.
void info_space(const std::string& name, const RunOptions& run);

}  // namespace stipple
