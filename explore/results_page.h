#pragma once

#include <cstddef>
#include <string>

#include "explore/exploration.h"

namespace stipple {

/// What the page of an exploration holds at most. The best points come first.
struct PageBounds {
    std::size_t points = 5000;                           ///< the table holds all
    std::size_t picture_bytes = std::size_t{16} << 20U;  ///< of the pictures in base64
};

/// The page of an exploration (docs/explore.md): an HTML file that needs no other one. `command`
/// made it; empty: not known.
[[nodiscard]] std::string results_page(const Exploration& exploration, const std::string& title,
                                       const std::string& command, const PageBounds& bounds = {});

}  // namespace stipple
