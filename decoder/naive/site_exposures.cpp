#include "decoder/naive/site_exposures.h"

#include <algorithm>

#include "decoder/measurements.h"

namespace stipple {

namespace {

void append_exposures(const Measurements& m, std::size_t site, std::vector<SiteExposure>& list) {
    SiteExposure chains[2];  // where exposures interleave, two are under way at once
    for (int slot = 0; slot < m.slots; ++slot) {
        const std::size_t i = static_cast<std::size_t>(slot) * m.shape.sites() + site;
        const std::uint8_t state = m.state[i];
        const auto chain = static_cast<std::uint8_t>(state & Measurements::kSecond);
        SiteExposure& e = chains[chain != 0 ? 1 : 0];
        if ((state & Measurements::kFirst) != 0) e = {.first_slot = slot, .chain = chain};
        if ((state & Measurements::kOpen) != 0) e.light_slots += m.weight_at(i);
        if ((state & Measurements::kLast) == 0) continue;
        const float n = e.light_slots;
        e.last_slot = slot;
        e.mean_weight = 1 / (0.3F + n);
        e.saturated = (state & Measurements::kSaturated) != 0;
        e.light_per_slot = m.sum[i] / n;
        e.variance_per_slot = m.variance[i] / (n * n);
        list.push_back(e);
    }
}

}  // namespace

void list_exposures(const Measurements& measurements, std::size_t site,
                    std::vector<SiteExposure>& list) {
    list.clear();
    append_exposures(measurements, site, list);
}

void list_all_exposures(const Measurements& measurements, std::size_t site,
                        std::vector<SiteExposure>& list) {
    list_exposures(measurements, site, list);
    if (measurements.others.empty()) return;
    for (const Measurements& other : measurements.others) append_exposures(other, site, list);
    std::ranges::stable_sort(list, {}, &SiteExposure::last_slot);
}

}  // namespace stipple
