#include "tests/support/source_tree.h"

#include <cstdlib>
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

}  // namespace

fs::path project_path(const fs::path& name) {
    return project_folder() / name;
}

fs::path built_program(const std::string& name) {
    return build_folder() / name;
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
