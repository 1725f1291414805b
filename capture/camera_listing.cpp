#include "capture/camera_listing.h"

#include "capture/camera_kind.h"
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
    for (const CameraKind& kind : camera_kinds())
        if (kind.list != nullptr) add_cameras(search, kind.list);
    return search;
}

}  // namespace stipple
