#pragma once

#include <string>
#include <vector>

#include "study/explore/space.h"

namespace stipple {

/// What a comparison of rivals (docs/rivals.md) changes in its space.
struct RivalsChoice {
    std::string footage;
    std::string sensor = {};                ///< empty: that of the space
    std::vector<std::string> systems = {};  ///< empty: all
    std::string dictionary = {};            ///< of hitomi2011; empty: that of the space

    /// For Space::replace.
    [[nodiscard]] std::vector<SpaceAxis> replaced() const;
    /// Of the page.
    [[nodiscard]] std::string title() const;
};

}  // namespace stipple
