#include "capture/camera_search.h"

#include <fmt/format.h>
#include <fnmatch.h>

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

bool matches(const std::string& name, const std::string& pattern) {
    const bool is_part = pattern.find_first_of("*?[") == std::string::npos;
    const std::string whole = is_part ? "*" + pattern + "*" : pattern;
    return fnmatch(whole.c_str(), name.c_str(), FNM_CASEFOLD) == 0;
}

}  // namespace

CameraSearch list_cameras() {
    CameraSearch search;
    for (const CameraKind& kind : camera_kinds())
        if (kind.list != nullptr) add_cameras(search, kind.list);
    return search;
}

std::vector<CameraFeature> camera_features(const std::string& address, const std::string& pattern) {
    const CameraKind& kind = camera_kind(address);
    if (kind.features == nullptr)
        throw InputError(address, "has no features; gige:IP, usb:SERIAL and v4l2:/dev/videoN have");
    std::vector<CameraFeature> features = kind.features(address);
    const std::size_t all = features.size();
    std::erase_if(features,
                  [&](const CameraFeature& feature) { return !matches(feature.name, pattern); });
    if (features.empty() && all > 0)
        throw InputError(fmt::format("\"{}\"", pattern),
                         fmt::format("matches none of the {} feature{} of {}", all,
                                     all == 1 ? "" : "s", address));
    return features;
}

}  // namespace stipple
