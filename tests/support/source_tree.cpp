// The only source that is compiled anew in another checkout: ccache serves the others.
#include "tests/support/source_tree.h"

#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/footage_folder.h"

namespace stipple {
namespace {

std::filesystem::path listed(const std::filesystem::path& path) {
    const char* const reads = std::getenv("STIPPLE_READS");
    if (reads == nullptr) return path;  // run by hand
    std::istringstream names(reads);
    for (std::string name; std::getline(names, name, ':');)
        if (path == name || path.string().starts_with(name + '/')) return path;
    throw std::logic_error(path.string() + " is not in READS of the test's CMakeLists.txt");
}

}  // namespace

std::filesystem::path project_path(const std::filesystem::path& name) {
    return listed(std::filesystem::path(STIPPLE_SOURCE_DIR) / name);
}

std::filesystem::path built_program(const std::string& name) {
    return listed(std::filesystem::path(STIPPLE_BINARY_DIR) / name);
}

std::filesystem::path footage_folder() {
    const char* folder = std::getenv("STIPPLE_FOOTAGE");
    return folder != nullptr ? std::filesystem::path(folder)
                             : std::filesystem::path(STIPPLE_SOURCE_DIR) / "../shared/footage";
}

std::optional<std::filesystem::path> footage_clip(const std::string& name) {
    const std::filesystem::path clip = footage_folder() / name;
    if (std::filesystem::exists(clip)) return clip;
    if (std::getenv("STIPPLE_FOOTAGE") == nullptr) return {};
    throw std::runtime_error("there is no footage " + clip.string() +
                             ", although STIPPLE_FOOTAGE names its folder");
}

}  // namespace stipple
