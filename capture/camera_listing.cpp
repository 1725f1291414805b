#include "capture/camera_listing.h"

#include "capture/aravis/aravis_camera.h"
#include "capture/v4l2/v4l2_listing.h"
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
    for (const auto source : {list_aravis_cameras, list_v4l2_cameras}) add_cameras(search, source);
    return search;
}

}  // namespace stipple
