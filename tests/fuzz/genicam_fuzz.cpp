#include <arv.h>

#include <string>

#include "capture/aravis/aravis_device.h"
#include "core/error.h"
#include "tests/fuzz/memory_file.h"

namespace {

/// Of what is not, Aravis (0.8.26) frees memory that it has not taken.
bool is_well_formed(const std::uint8_t* data, std::size_t size) {
    constexpr GMarkupParser kNothing{};
    GMarkupParseContext* context = g_markup_parse_context_new(&kNothing, {}, nullptr, nullptr);
    const auto* text = reinterpret_cast<const char*>(data);
    const bool good =
        g_markup_parse_context_parse(context, text, static_cast<gssize>(size), nullptr) != FALSE &&
        g_markup_parse_context_end_parse(context, nullptr) != FALSE;
    g_markup_parse_context_free(context);
    return good && g_str_has_prefix(std::string(text, size).c_str(), "<?xml version=") != FALSE;
}

}  // namespace

/// Input: the XML by which a camera describes itself. Its features are listed, read and set as
/// `capture doctor` and `capture record` do.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    g_log_set_default_handler([](auto...) {}, nullptr);  // what libxml2 says of each input
    if (!is_well_formed(data, size)) return 0;
    const MemoryFile xml({data, size});
    arv_set_fake_camera_genicam_filename(xml.path().c_str());
    ArvDevice* native = arv_fake_device_new("fuzz", nullptr);
    if (native == nullptr) return 0;
    try {
        AravisDevice device("fake:fuzz", native);
        if (device.genicam_xml().size() > size) std::abort();
        for (const auto& [name, value] : device.features()) {
            static_cast<void>(device.read_number(name));
            try {
                device.set(name, value);
            } catch (const std::exception&) {
                continue;  // the camera refuses it
            }
        }
    } catch (const DeviceError&) {
        return 0;
    }
    return 0;
}
