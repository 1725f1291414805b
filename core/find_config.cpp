#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/config.h"
#include "core/error.h"
#include "core/executable_dirs.h"
#include "core/text.h"

/// The folder of the package that a program was built with: stippleConfig.cmake gives it the source
/// that defines this.
extern "C" [[gnu::weak]] const char* stipple_package_config_dir();

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Folders that hold sensors/, schedules/ and the other kinds; the first one that has a name wins.
std::vector<fs::path> config_folders() {
    std::vector<fs::path> folders;
    if (const char* folder = std::getenv("STIPPLE_CONFIG_DIR")) folders.emplace_back(folder);
    for (const fs::path& own : executable_dirs()) {
        folders.push_back((own / "../share/stipple/config").lexically_normal());
        folders.push_back((own / "../../share/stipple/config").lexically_normal());  // lib/MACHINE
        folders.push_back(own / "config");  // a build folder, the Python package
    }
    if (&stipple_package_config_dir != nullptr) folders.emplace_back(stipple_package_config_dir());
    folders.emplace_back(STIPPLE_INSTALLED_CONFIG_DIR);
    return folders;
}

std::string_view extension_of(ConfigKind kind) {
    return kind == ConfigKind::kModels ? ".safetensors" : ".toml";
}

/// "A, B and C" of the folders.
std::string searched() {
    std::vector<std::string> names;
    for (const fs::path& folder : config_folders()) names.push_back(folder.string());
    return joined(names);
}

}  // namespace

std::string_view folder_of(ConfigKind kind) {
    switch (kind) {
        case ConfigKind::kSensors:
            return "sensors";
        case ConfigKind::kSchedules:
            return "schedules";
        case ConfigKind::kSpaces:
            return "spaces";
        case ConfigKind::kRigs:
            return "rigs";
        case ConfigKind::kModels:
            return "models";
    }
    return {};
}

std::vector<std::string> config_names(ConfigKind kind) {
    std::set<std::string> names;
    for (const fs::path& folder : config_folders()) {
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(folder / folder_of(kind), error))
            if (entry.path().extension() == extension_of(kind))
                names.insert(entry.path().stem().string());
    }
    return {names.begin(), names.end()};
}

void require_configs(ConfigKind kind) {
    if (config_names(kind).empty())
        throw InputError("configuration",
                         fmt::format("there is no {}/ in {}; set STIPPLE_CONFIG_DIR to a folder "
                                     "that has it, as PREFIX/share/stipple/config",
                                     folder_of(kind), searched()));
}

fs::path find_config(ConfigKind kind, std::string_view name) {
    std::error_code error;
    fs::path path(name);
    if (fs::is_regular_file(path, error)) return path;
    if (name.find('/') != std::string_view::npos || path.extension() == extension_of(kind))
        throw InputError(name, "there is no such file");
    for (const fs::path& folder : config_folders()) {
        fs::path file = folder / folder_of(kind) / fmt::format("{}{}", name, extension_of(kind));
        if (fs::is_regular_file(file, error)) return file;
    }
    require_configs(kind);
    throw InputError(fmt::format("\"{}\"", name),
                     fmt::format("is neither a file nor one of the {}; {}", folder_of(kind),
                                 suggestion(name, config_names(kind))));
}

}  // namespace stipple
