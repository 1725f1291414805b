#include "apps/output/leftovers.h"

#include <fmt/format.h>

#include <system_error>

#include "apps/standard_streams.h"
#include "io/partial_output.h"

namespace stipple {
namespace fs = std::filesystem;

void say_leftover(const fs::path& output) {
    std::error_code error;
    const bool linked = fs::is_symlink(fs::symlink_status(output, error));
    const fs::path file = linked ? fs::canonical(output, error) : output;
    const fs::path name = file.has_filename() ? file : file.parent_path();
    const fs::path folder = folder_of(name);
    for (const PartialOutput& partial : partial_outputs(folder)) {
        if (partial.final_path.filename() != name.filename() || partial.running()) continue;
        say_warning("{}: a run that was killed left {}; `stipple recover {}` says what can be kept",
                    output.string(), partial.path.filename().string(), folder.string());
        return;
    }
}

std::string leftover_text(const fs::path& file) {
    const auto partial = partial_output(file);
    if (!partial) return {};
    if (partial->running()) return fmt::format("; process {} is writing it", partial->process);
    return fmt::format("; its run was killed, `stipple recover {}` keeps it", file.string());
}

}  // namespace stipple
