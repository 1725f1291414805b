#include "core/executable_dirs.h"

#include <dlfcn.h>

#include <system_error>

namespace stipple {
namespace fs = std::filesystem;

std::vector<fs::path> executable_dirs() {
    std::vector<fs::path> folders;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&executable_dirs), &info) != 0) {
        // Of a program the name is what it was called by, which may be relative, or of another
        // file.
        const fs::path file(info.dli_fname);
        if (file.is_absolute() && !fs::equivalent(file, program, error))
            folders.push_back(file.parent_path());
    }
    if (!program.empty()) folders.push_back(program.parent_path());
    return folders;
}

}  // namespace stipple
