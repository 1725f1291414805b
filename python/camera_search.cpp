#include <pybind11/stl.h>

#include <string>
#include <tuple>
#include <vector>

#include "capture/camera_search.h"
#include "python/bindings.h"

namespace stipple::python {
namespace {

/// The fields of capture.CameraListing in stipple/capture.py.
py::tuple listing_tuple(const CameraListing& camera) {
    return py::make_tuple(camera.address, camera.transport, camera.vendor, camera.model,
                          camera.serial);
}

/// Cameras that were found, and why some kinds of cameras could not be searched.
std::tuple<py::list, std::vector<std::string>> find_cameras() {
    const CameraSearch search = [] {
        const py::gil_scoped_release released;
        return list_cameras();
    }();
    py::list cameras;
    for (const CameraListing& camera : search.cameras) cameras.append(listing_tuple(camera));
    return {cameras, search.problems};
}

/// The fields of capture.CameraFeature in stipple/capture.py.
py::tuple feature_tuple(const CameraFeature& feature) {
    return py::make_tuple(feature.name, feature.category, feature.type, feature.access,
                          feature.locked, feature.value, feature.unit, feature.minimum,
                          feature.maximum, feature.increment, py::tuple(py::cast(feature.choices)),
                          feature.text);
}

py::list features(const std::string& address, const std::string& pattern) {
    const std::vector<CameraFeature> found = [&] {
        const py::gil_scoped_release released;
        return camera_features(address, pattern);
    }();
    py::list list;
    for (const CameraFeature& feature : found) list.append(feature_tuple(feature));
    return list;
}

}  // namespace

void bind_camera_search(py::module_& module) {
    module.def("find_cameras", &find_cameras);
    module.def("camera_features", &features);
}

}  // namespace stipple::python
