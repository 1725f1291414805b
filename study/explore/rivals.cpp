#include "study/explore/rivals.h"

#include <filesystem>

namespace stipple {

std::vector<SpaceAxis> RivalsChoice::replaced() const {
    std::vector<SpaceAxis> axes{{"footage", {footage}}};
    if (!sensor.empty()) axes.push_back({"sensor", {sensor}});
    if (!systems.empty()) axes.push_back({"system", systems});
    if (!dictionary.empty()) axes.push_back({"decoder.dictionary", {dictionary}});
    return axes;
}

std::string RivalsChoice::title() const {
    return "Rivals: " + std::filesystem::path(footage).filename().string();
}

}  // namespace stipple
