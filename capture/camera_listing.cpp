#include "capture/camera_listing.h"

#include "capture/aravis_camera.h"
#include "core/error.h"

namespace stipple {
namespace {

void add_cameras(CameraSearch& search, std::vector<CameraListing> (*source)()) {
    try {
        const auto found = source();
        search.cameras.insert(search.cameras.end(), found.begin(), found.end());
    } catch (const DeviceError& e) {
        search.problems.emplace_back(e.what());
    }
}

}  // namespace

CameraSearch list_cameras() {
    CameraSearch search;
    for (const auto source : {list_aravis_cameras}) add_cameras(search, source);
    return search;
}

}  // namespace stipple
