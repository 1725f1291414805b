#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

struct Measurements;

/// An exposure of a site, with its sample.
struct SiteExposure {
    int first_slot = 0;
    int last_slot = 0;
    int open_slots = 0;
    bool saturated = false;
    std::uint8_t chain = 0;       ///< 0, or Measurements::kSecond
    float light_per_slot = 0;     ///< a lower bound if saturated
    float variance_per_slot = 0;  ///< of `light_per_slot`
};

/// Sets `list` to the exposures of a site that have samples, in the order of their ends.
void list_exposures(const Measurements& measurements, std::size_t site,
                    std::vector<SiteExposure>& list);

}  // namespace stipple
