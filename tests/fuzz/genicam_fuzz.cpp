#include <arv.h>
#include <dlfcn.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "capture/aravis/aravis_device.h"
#include "core/error.h"
#include "tests/support/memory_file.h"

namespace {

/// Of XML that begins otherwise, Aravis (0.8.26) may free memory that it has not taken: case 5 of
/// docs/notes/aravis_xml.md.
constexpr std::string_view kDeclaration = R"(<?xml version="1.0"?>)";

}  // namespace

/// In place of Aravis' own (0.8.26), which reads and writes out of bounds if the address lies far
/// beyond the memory of its fake camera. Real cameras answer themselves.
extern "C" gboolean arv_fake_camera_read_memory(ArvFakeCamera* camera, guint32 address,
                                                guint32 size, void* buffer) {
    static const auto read = reinterpret_cast<decltype(&arv_fake_camera_read_memory)>(
        dlsym(RTLD_NEXT, "arv_fake_camera_read_memory"));
    if (std::uint64_t{address} + size <= ARV_FAKE_CAMERA_MEMORY_SIZE)
        return read(camera, address, size, buffer);
    std::memset(buffer, 0, size);
    return TRUE;
}

/// As above.
extern "C" gboolean arv_fake_camera_write_memory(ArvFakeCamera* camera, guint32 address,
                                                 guint32 size, const void* buffer) {
    static const auto write = reinterpret_cast<decltype(&arv_fake_camera_write_memory)>(
        dlsym(RTLD_NEXT, "arv_fake_camera_write_memory"));
    return std::uint64_t{address} + size <= ARV_FAKE_CAMERA_MEMORY_SIZE &&
           write(camera, address, size, buffer);
}

/// Input: the XML by which a camera describes itself. Its features are listed, described, read and
/// set as `capture features`, `capture doctor` and `capture record` do.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    if (!std::string_view(reinterpret_cast<const char*>(data), size).starts_with(kDeclaration))
        return 0;
    g_log_set_default_handler([](auto...) {}, nullptr);  // what libxml2 says of each input
    const MemoryFile xml({data, size});
    arv_set_fake_camera_genicam_filename(xml.path().c_str());
    ArvDevice* native = arv_fake_device_new("fuzz", nullptr);
    if (native == nullptr) return 0;
    try {
        AravisDevice device("fake:fuzz", native);
        if (device.genicam_xml().size() > size) std::abort();
        static_cast<void>(describe_features(device));
        for (const auto& [name, value] : device.features()) {
            static_cast<void>(device.read_number(name));
            try {
                device.set(name, value);
            } catch (const InputError&) {
                continue;  // the camera refuses it
            }
        }
    } catch (const DeviceError&) {
        return 0;
    }
    return 0;
}
