#include "decoder/naive/nearest_samples.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/site_exposures.h"

namespace stipple {
namespace {

/// exp(-d / 1.5) for a distance of d slots; further away nothing changes.
constexpr std::array<float, 17> kCloseness = {
    1.0F,           5.13417119e-1F, 2.63597138e-1F, 1.35335283e-1F, 6.94834512e-2F, 3.56739933e-2F,
    1.83156389e-2F, 9.40356255e-3F, 4.82794999e-3F, 2.47875218e-3F, 1.27263380e-3F, 6.53391981e-4F,
    3.35462628e-4F, 1.72232257e-4F, 8.84270376e-5F, 4.53999298e-5F, 2.33091012e-5F};

/// What the exposures of a site say of one slot; `own` is the exposure that the slot is in, or
/// none.
float estimate(const std::vector<SiteExposure>& list, int slot, const SiteExposure* own) {
    float light = 0;
    float weight = 0;
    float bound = 0;
    bool near = false;
    for (const SiteExposure& e : list) {
        if (own != nullptr && &e != own && e.light_slots >= own->light_slots) continue;
        const int distance = std::max({0, e.first_slot - slot, slot - e.last_slot});
        if (e.saturated) {
            if (distance <= kNearSlots) bound = std::max(bound, e.light_per_slot);
            continue;
        }
        near = near || distance <= kNearSlots;
        light += e.mean_weight * temporal_weight(distance) * e.light_per_slot;
        weight += e.mean_weight * temporal_weight(distance);
    }
    if (weight == 0 || (bound > 0 && !near)) return bound;
    return own != nullptr && own->saturated ? std::max(light / weight, own->light_per_slot)
                                            : light / weight;
}

/// False if the site has no samples; then its light is not set.
bool estimate_site(const Measurements& m, std::size_t site, std::vector<SiteExposure>& list,
                   float* x) {
    list_exposures(m, site, list);
    if (list.empty()) return false;
    auto next = list.begin();
    for (int slot = 0; slot < m.slots; ++slot) {
        const std::size_t i = static_cast<std::size_t>(slot) * m.shape.sites() + site;
        while (next != list.end() && next->last_slot < slot) ++next;
        const bool open = (m.state[i] & Measurements::kOpen) != 0;
        auto own = next;
        while (open && own->chain != (m.state[i] & Measurements::kSecond)) ++own;
        x[i] = estimate(list, slot, open ? &*own : nullptr);
    }
    return true;
}

}  // namespace

float temporal_weight(int distance_slots) noexcept {
    return kCloseness[std::min(index(distance_slots), kCloseness.size() - 1)];
}

FluxVideo nearest_samples(const Measurements& measurements) {
    if (!measurements.others.empty()) return joint_nearest_samples(measurements);
    FluxVideo x(measurements.slots, measurements.shape);
    std::vector<std::uint8_t> sampled(measurements.shape.sites());
    const auto cols = static_cast<std::size_t>(measurements.shape.cols);
    parallel_for(0, measurements.shape.planes * measurements.shape.rows, [&](int row) {
        std::vector<SiteExposure> list;
        const std::size_t begin = static_cast<std::size_t>(row) * cols;
        for (std::size_t site = begin; site < begin + cols; ++site)
            sampled[site] = estimate_site(measurements, site, list, x.data().data()) ? 1 : 0;
    });
    fill_unsampled(sampled, x);
    return x;
}

}  // namespace stipple
