#include <arv.h>

#include "capture/aravis/aravis_camera.h"

namespace stipple {
namespace {

std::string text(const char* value) {
    return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

std::vector<CameraListing> list_aravis_cameras() {
    arv_disable_interface("Fake");
    arv_update_device_list();
    std::vector<CameraListing> cameras;
    for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
        const bool gige = text(arv_get_device_protocol(i)) == "GigEVision";
        const std::string serial = text(arv_get_device_serial_nbr(i));
        cameras.push_back({gige ? "gige:" + text(arv_get_device_address(i)) : "usb:" + serial,
                           gige ? "GigE Vision" : "USB3 Vision", text(arv_get_device_vendor(i)),
                           text(arv_get_device_model(i)), serial});
    }
    return cameras;
}

}  // namespace stipple
