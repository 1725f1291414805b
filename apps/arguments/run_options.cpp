#include "apps/arguments/run_options.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/arguments/checks.h"
#include "apps/arguments/command_line.h"
#include "apps/standard_error.h"
#include "core/memory_limit.h"
#include "stream/plain_text.h"

namespace stipple {

void RunOptions::say(std::string_view text) const {
    if (quiet || json == "-") return;
    clear_bar();
    fmt::print("{}\n", terminal_text(text));
}

void add_run_options(Command& command, RunOptions& run) {
    command.add_option("--json", run.json, "write the figures as JSON; - is standard output")
        .type_name("FILE")
        .output();
    command.add_flag("--force", run.force, "replace existing outputs");
    command.add_flag("--no-sync", run.no_sync,
                     "do not wait until outputs are on the disk; a power cut may lose them");
    command
        .add_parsed(
            "--max-memory",
            [&run](const std::string& size) {
                const auto bytes = parse_memory(size);
                if (!bytes)
                    throw UsageError("--max-memory",
                                     "\"" + size + "\" is not a size like 512M or 2G, from 1M on");
                run.max_memory = *bytes;
            },
            "refuse inputs that need more memory (a quarter of the machine's)")
        .type_name("SIZE");
    command.add_flag("-q,--quiet", run.quiet, "print errors and warnings only");
}

CommandOption add_threads(Command& command, RunOptions& run) {
    return command.add_option("--threads", run.threads, "threads to use; 0 is one per core")
        .check(whole_check(0, 1024))
        .type_name("N");
}

}  // namespace stipple
