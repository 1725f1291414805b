#include "io/output_names.h"

#include <algorithm>
#include <system_error>

#include "io/footage_files.h"

namespace stipple {
namespace fs = std::filesystem;

bool is_pipe(const fs::path& output) {
    std::error_code error;
    return output == "-" || fs::is_fifo(output, error);
}

std::string name_problem(const fs::path& file, const OutputName& name) {
    std::error_code error;
    if (name.rule.empty() || (fs::exists(file, error) && !fs::is_regular_file(file, error)))
        return {};
    const auto is_known = [&](const std::string& extension) {
        return std::ranges::find(name.extensions, extension) != name.extensions.end();
    };
    const std::string extension = lower_extension(file);
    // Of ".npy" the whole name is one, of which C++ says that it has no extension.
    const std::string whole = lower_extension(fs::path("x") += file.filename());
    if (extension.empty() && !whole.empty() && is_known(whole))
        return "is an extension only; put a name before it";
    const bool is_of_rule = extension.empty() ? name.may_have_none : is_known(extension);
    return is_of_rule ? std::string() : std::string(name.rule);
}

}  // namespace stipple
