#include "decoder/motion/lazy_opencv.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "core/error.h"
#include "core/executable_dirs.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

void* load(const char* function) {
    constexpr const char* kName = "libstipple_opencv.so";
    std::vector<fs::path> folders;
    for (const fs::path& own : executable_dirs()) {
        folders.push_back(own);
        folders.push_back(own / STIPPLE_LIBRARY_FROM_PROGRAM);
        folders.push_back(own / "stipple");  // beside libstipple.so
    }
    folders.emplace_back(STIPPLE_LIBRARY_DIR);
    std::string why;
    for (const fs::path& folder : folders) {
        void* const library = dlopen((folder / kName).c_str(), RTLD_LAZY);
        void* const flow = library ? dlsym(library, function) : nullptr;
        if (flow != nullptr) return flow;
        why += fmt::format("{}{}", why.empty() ? "" : "; ", dlerror());
    }
    throw DeviceError(
        kName, "cannot be loaded; it belongs beside the program, or into lib/stipple: " + why);
}

}  // namespace

void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow) {
    static auto* const calculate =
        reinterpret_cast<decltype(tv_l1_flow)*>(load("stipple_tv_l1_flow"));
    calculate(from, to, flow);
}

void dis_flow(PlaneView<const float> from, PlaneView<const float> to, std::span<float> flow) {
    static auto* const calculate = reinterpret_cast<decltype(dis_flow)*>(load("stipple_dis_flow"));
    calculate(from, to, flow);
}

ImageNetwork open_network(std::span<const std::uint8_t> onnx) {
    static auto* const open =
        reinterpret_cast<void (*)(std::span<const std::uint8_t>, ImageNetwork&)>(
            load("stipple_open_network"));
    ImageNetwork network;
    open(onnx, network);
    return network;
}

void QuietOpenCv::swap_settings() {
    static auto* const swap =
        reinterpret_cast<void (*)(int&, int&)>(load("stipple_swap_opencv_settings"));
    swap(threads_, log_level_);
}

}  // namespace stipple
