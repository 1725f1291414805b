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
    float light_slots = 0;  ///< sum of the weights of the open slots; without weights their number
    float mean_weight = 0;  ///< 1 / (0.3 + light_slots), as of nearest_samples.h
    bool saturated = false;
    std::uint8_t chain = 0;       ///< 0, or Measurements::kSecond
    float light_per_slot = 0;     ///< a lower bound if saturated
    float variance_per_slot = 0;  ///< of `light_per_slot`
};

/// Sets `list` to the exposures of a site that have samples, in the order of their ends.
void list_exposures(const Measurements& measurements, std::size_t site,
                    std::vector<SiteExposure>& list);

/// The same of all sensors, in the order of their ends, then of the sensors.
void list_all_exposures(const Measurements& measurements, std::size_t site,
                        std::vector<SiteExposure>& list);

}  // namespace stipple
