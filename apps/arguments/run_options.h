#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stipple {

class Command;
class CommandOption;

/// Values of the options that every command has, and of --threads.
struct RunOptions {
    bool quiet = false;
    bool force = false;
    bool no_sync = false;          ///< see NoSync
    std::uint64_t max_memory = 0;  ///< bytes; 0: see max_memory
    int threads = 0;               ///< 0: all cores; of those that have `--threads`
    std::string json;              ///< file for the figures; empty: none, "-": standard output

    bool notes_only = false;  ///< standard output is for data

    /// Prints `text` for people on standard output, or as a note on standard error, unless it shall
    /// be quiet or has JSON on it. \throws std::system_error if it cannot be written.
    void say(std::string_view text) const;
};

/// The options that every command has: `--json`, `--force`, `--no-sync`, `--max-memory` and
/// `--quiet`.
void add_run_options(Command& command, RunOptions& run);

/// `--threads`, of subcommands that spread their work (core/parallel.h).
CommandOption add_threads(Command& command, RunOptions& run);

}  // namespace stipple
