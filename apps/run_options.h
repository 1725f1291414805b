#pragma once

#include <string>
#include <string_view>

namespace stipple {

class Command;

/// What every subcommand can be told.
struct RunOptions {
    bool quiet = false;
    bool force = false;
    int threads = 0;   ///< 0: all cores
    std::string json;  ///< file for the figures; empty: none, "-": standard output

    /// Prints `text` for people on standard output, unless it shall be quiet or has JSON on it.
    /// \throws std::system_error if it cannot be written.
    void say(std::string_view text) const;
};

void add_run_options(Command& command, RunOptions& run);

}  // namespace stipple
