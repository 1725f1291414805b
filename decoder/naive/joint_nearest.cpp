#include "decoder/naive/nearest_samples.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/site_exposures.h"

namespace stipple {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

bool includes(const SiteExposure& e, int slot) {
    return e.first_slot <= slot && slot <= e.last_slot;
}

/// What the exposures that include a slot say of all others.
struct OwnExposures {
    float shortest = kNever;  ///< light slots of the shortest that is not saturated
    float bound = 0;          ///< of the saturated ones
};

OwnExposures own_exposures(const std::vector<SiteExposure>& list, int slot) {
    OwnExposures own;
    float shortest_saturated = kNever;
    for (const SiteExposure& e : list) {
        if (!includes(e, slot)) continue;
        float& shortest = e.saturated ? shortest_saturated : own.shortest;
        shortest = std::min(shortest, e.light_slots);
        if (e.saturated) own.bound = std::max(own.bound, e.light_per_slot);
    }
    if (own.shortest == kNever)
        own.shortest = shortest_saturated;
    else
        own.bound = 0;
    return own;
}

float estimate(const std::vector<SiteExposure>& list, int slot) {
    const OwnExposures own = own_exposures(list, slot);
    float light = 0;
    float weights = 0;
    float bound = 0;
    bool near = false;
    for (const SiteExposure& e : list) {
        if (!includes(e, slot) && e.light_slots >= own.shortest) continue;
        const int distance = std::max({0, e.first_slot - slot, slot - e.last_slot});
        if (e.saturated) {
            if (distance <= kNearSlots) bound = std::max(bound, e.light_per_slot);
            continue;
        }
        near = near || distance <= kNearSlots;
        const float weight =
            e.mean_weight * temporal_weight(distance) / (e.light_slots * e.variance_per_slot);
        light += weight * e.light_per_slot;
        weights += weight;
    }
    if (weights == 0 || (bound > 0 && !near)) return bound;
    return std::max(light / weights, own.bound);
}

}  // namespace

FluxVideo joint_nearest_samples(const Measurements& measurements) {
    const FrameShape shape = measurements.shape;
    FluxVideo x(measurements.slots, shape);
    std::vector<std::uint8_t> sampled(shape.sites());
    parallel_for(0, shape.planes * shape.rows, [&](int row) {
        std::vector<SiteExposure> list;
        const std::size_t begin = index(row) * index(shape.cols);
        for (std::size_t site = begin; site < begin + index(shape.cols); ++site) {
            list_all_exposures(measurements, site, list);
            sampled[site] = list.empty() ? 0 : 1;
            for (int slot = 0; !list.empty() && slot < measurements.slots; ++slot)
                x.data()[index(slot) * shape.sites() + site] = estimate(list, slot);
        }
    });
    fill_unsampled(sampled, x);
    return x;
}

}  // namespace stipple
