#include "tests/support/source_tree.h"

#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/footage_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

fs::path build_folder() {
    return fs::canonical("/proc/self/exe").parent_path();
}

/// Of the checkout: the build folder has a link to its configurations.
fs::path project_folder() {
    return fs::canonical(build_folder() / "config").parent_path();
}

fs::path listed(const fs::path& path) {
    const char* const reads = std::getenv("STIPPLE_READS");
    if (reads == nullptr) return path;  // run by hand
    std::istringstream names(reads);
    for (std::string name; std::getline(names, name, ':');)
        if (path == fs::weakly_canonical(name) ||
            path.string().starts_with(fs::weakly_canonical(name).string() + '/'))
            return path;
    throw std::logic_error(path.string() + " is not in READS of the test's CMakeLists.txt");
}

}  // namespace

fs::path project_path(const fs::path& name) {
    return listed(project_folder() / name);
}

fs::path built_program(const std::string& name) {
    return listed(build_folder() / name);
}

fs::path footage_folder() {
    const char* folder = std::getenv("STIPPLE_FOOTAGE");
    return folder != nullptr ? fs::path(folder) : project_folder() / "../shared/footage";
}

std::optional<fs::path> footage_clip(const std::string& name) {
    const fs::path clip = footage_folder() / name;
    if (fs::exists(clip)) return clip;
    if (std::getenv("STIPPLE_FOOTAGE") == nullptr) return {};
    throw std::runtime_error("there is no footage " + clip.string() +
                             ", although STIPPLE_FOOTAGE names its folder");
}

}  // namespace stipple
