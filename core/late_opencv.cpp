#include "core/late_opencv.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"

namespace stipple {
namespace fs = std::filesystem;

const LateOpenCv& late_opencv() {
    constexpr const char* kName = "libstipple_opencv.so";
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    std::string why;
    for (const fs::path& folder : {program, fs::path(STIPPLE_BUILD_DIR)}) {
        void* const library =
            dlopen((folder / kName).c_str(), RTLD_LAZY);  // once, then found again
        const void* const functions = library ? dlsym(library, "stipple_late_opencv") : nullptr;
        if (functions != nullptr) return *static_cast<const LateOpenCv*>(functions);
        why += fmt::format("{}{}", why.empty() ? "" : "; ", dlerror());
    }
    throw DeviceError(kName, "cannot be loaded; it belongs beside the program: " + why);
}

}  // namespace stipple
