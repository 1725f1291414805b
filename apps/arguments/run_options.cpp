#include "apps/arguments/run_options.h"

#include "apps/arguments/command_line.h"
#include "apps/arguments/common_options.h"
#include "apps/standard_streams.h"
#include "core/memory_limit.h"
#include "stream/plain_text.h"

namespace stipple {

void RunOptions::say(std::string_view text) const {
    if (quiet || json == "-") return;
    if (notes_only) return say_note(text);
    clear_bar();
    print_text(terminal_text(text) + "\n");
}

void add_run_options(Command& command, RunOptions& run) {
    command
        .add_option("--json", run.json,
                    "write the figures of the run as JSON; - is standard output, without text then")
        .type_name("FILE")
        .group(kCommonOptions)
        .output({.may_be_pipe = true});
    command
        .add_flag("--force", run.force,
                  "replace existing outputs, the file of --json too; of a link the file behind it")
        .group(kCommonOptions);
    command
        .add_flag("--no-sync", run.no_sync,
                  "do not wait until outputs are on the disk; a power cut may lose them")
        .group(kCommonOptions);
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
            "refuse inputs that need more memory, such as 512M or 2G")
        .default_text("a quarter of the machine's memory")
        .type_name("SIZE")
        .group(kCommonOptions);
    command.add_flag("-q,--quiet", run.quiet, "print errors and warnings only")
        .group(kCommonOptions);
}

CommandOption add_threads(Command& command, RunOptions& run) {
    return command
        .add_option("--threads", run.threads,
                    "number of threads; 0: one per core. The result has the same bits for any N")
        .shows_default()
        .check(whole_check(0, 1024))
        .type_name("N");
}

}  // namespace stipple
