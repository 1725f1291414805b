#include "decoder/frame_exposures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "core/index.h"
#include "decoder/measurements.h"
#include "decoder/motion/frame_interpolation.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

/// Slots. The centres of different exposures of up to 64 slots lie further apart; those of weights
/// that differ by a factor differ by rounding.
constexpr float kSameCentre = 1.0F / 128;

/// Exposures by their last slot, and how many sites have each.
class ExposureList {
  public:
    /// False if it is not the same as one that ends with it.
    bool add(const FrameExposure& exposure) {
        Entry& entry = entries_.try_emplace(exposure.last_slot, Entry{exposure, 0}).first->second;
        ++entry.sites;
        const FrameExposure& known = entry.exposure;
        return known.first_slot == exposure.first_slot && known.open_slots == exposure.open_slots &&
               std::abs(known.centre_slot - exposure.centre_slot) <= kSameCentre;
    }
    [[nodiscard]] std::vector<FrameExposure> in_order() const {
        std::vector<FrameExposure> result;
        for (const auto& [last_slot, entry] : entries_) result.push_back(entry.exposure);
        return result;
    }
    /// True if each is of half the sites or more: of the others samples are missing.
    [[nodiscard]] bool each_of_most(std::size_t sites) const {
        return std::ranges::all_of(
            entries_, [&](const auto& entry) { return 2 * entry.second.sites >= sites; });
    }

  private:
    struct Entry {
        FrameExposure exposure;
        std::size_t sites;
    };
    std::map<int, Entry> entries_;
};

enum class Site { kAdded, kWithoutSamples, kContradicts };

/// Adds the exposures of one site to the list.
Site add_site(const Measurements& m, std::size_t site, ExposureList& list) {
    Site result = Site::kWithoutSamples;
    FrameExposure exposure;
    float sum = 0;
    float weights = 0;
    for (int slot = 0; slot < m.slots; ++slot) {
        const std::size_t i = index(slot) * m.shape.sites() + site;
        const std::uint8_t state = m.state[i];
        if ((state & Measurements::kFirst) != 0) {
            exposure = {.first_slot = slot};
            sum = weights = 0;
        }
        if ((state & Measurements::kOpen) != 0) {
            ++exposure.open_slots;
            sum += m.weight_at(i) * static_cast<float>(slot);
            weights += m.weight_at(i);
        }
        if ((state & Measurements::kLast) == 0) continue;
        exposure.last_slot = slot;
        exposure.centre_slot = sum / weights;
        if (!list.add(exposure)) return Site::kContradicts;
        result = Site::kAdded;
    }
    return result;
}

bool overlap(const FrameExposure& a, const FrameExposure& b) {
    return b.first_slot <= a.last_slot;
}

int span(const FrameExposure& exposure) {
    return exposure.last_slot - exposure.first_slot + 1;
}

struct SharedExposures {
    std::vector<FrameExposure> exposures;
    bool each_of_most = false;  ///< of the sites with samples
};

/// Nothing if sites differ or exposures overlap.
std::optional<SharedExposures> find_exposures(const Measurements& measurements) {
    if (measurements.interleaved) return {};
    ExposureList list;
    std::size_t sites = 0;
    for (std::size_t i = 0; i < measurements.shape.sites(); ++i) {
        const Site site = add_site(measurements, i, list);
        if (site == Site::kContradicts) return {};
        if (site == Site::kAdded) ++sites;
    }
    SharedExposures found{list.in_order(), list.each_of_most(sites)};
    const std::vector<FrameExposure>& exposures = found.exposures;
    if (std::ranges::adjacent_find(exposures, overlap) != exposures.end()) return {};
    return found;
}

/// The sum of the weights of each exposure, at its last voxel; of their squares if `squared`.
/// Nothing without weights.
std::vector<float> sums_of_weights(const Measurements& measurements, bool squared) {
    if (measurements.weight.empty()) return {};
    std::vector<float> sums(measurements.voxels());
    const std::vector<float> ones(squared ? 0 : measurements.voxels(), 1.0F);
    sample(measurements, squared ? measurements.weight : ones, sums);
    return sums;
}

}  // namespace

std::optional<std::vector<FrameExposure>> shared_exposures(const Measurements& measurements) {
    const auto found = find_exposures(measurements);
    return found ? found->exposures : std::optional<std::vector<FrameExposure>>();
}

bool equally_long(std::span<const FrameExposure> exposures) {
    return std::ranges::all_of(exposures, [&](const FrameExposure& e) {
        return span(e) == span(exposures.front()) && e.open_slots == exposures.front().open_slots;
    });
}

std::optional<std::vector<FrameExposure>> frame_exposures(const Measurements& measurements) {
    if (!measurements.weight.empty()) return {};
    auto found = find_exposures(measurements);
    if (!found || found->exposures.empty() || !found->each_of_most) return {};
    if (!equally_long(found->exposures)) return {};
    return std::move(found->exposures);
}

Measurements measurements_of_frames(const Measurements& measurements,
                                    std::span<const FrameExposure> exposures,
                                    const SampleNoise& noise) {
    const std::size_t sites = measurements.shape.sites();
    const std::size_t voxels = exposures.size() * sites;
    Measurements result{.slots = static_cast<int>(exposures.size()),
                        .shape = measurements.shape,
                        .state = std::vector<std::uint8_t>(voxels),
                        .sum = std::vector<float>(voxels),
                        .variance = std::vector<float>(voxels),
                        .mosaic = measurements.mosaic,
                        .dark_variance = std::vector<float>(voxels),
                        .variance_per_light = std::vector<float>(voxels)};
    const bool own_noise = !measurements.dark_variance.empty();
    const std::vector<float> weights = sums_of_weights(measurements, false);
    for (std::size_t frame = 0; frame < exposures.size(); ++frame) {
        const auto open_slots = static_cast<float>(exposures[frame].open_slots);
        const std::size_t from = index(exposures[frame].last_slot) * sites;
        const std::size_t to = frame * sites;
        for (std::size_t site = 0; site < sites; ++site) {
            const std::uint8_t state = measurements.state[from + site];
            if ((state & Measurements::kLast) == 0) continue;
            const float n = weights.empty() ? open_slots : weights[from + site];
            result.state[to + site] = static_cast<std::uint8_t>(
                Measurements::kOpen | Measurements::kFirst | Measurements::kLast |
                (state & (Measurements::kSaturated | Measurements::kZero)));
            result.sum[to + site] = measurements.sum[from + site] / n;
            result.dark_variance[to + site] =
                (own_noise ? measurements.dark_variance[from + site] : noise.variance(0)) / (n * n);
            result.variance_per_light[to + site] =
                (own_noise ? measurements.variance_per_light[from + site] : noise.per_light()) / n;
            result.variance[to + site] = result.variance_at(to + site, result.sum[to + site]);
        }
    }
    return result;
}

void back_project_residual(const Measurements& measurements,
                           std::span<const FrameExposure> exposures, const FluxVideo& frames,
                           FluxVideo& x) {
    const std::size_t sites = measurements.shape.sites();
    const std::vector<float> weights = sums_of_weights(measurements, false);
    const std::vector<float> squares = sums_of_weights(measurements, true);
    std::vector<float> lack(measurements.voxels());
    sample(measurements, x.data(), lack);
    for (std::size_t k = 0; k < exposures.size(); ++k) {
        const auto n = static_cast<float>(exposures[k].open_slots);
        const auto frame = frames.frame(static_cast<int>(k));
        const std::size_t last = index(exposures[k].last_slot) * sites;
        for (std::size_t site = 0; site < sites; ++site) {
            float& light = lack[last + site];
            if (weights.empty())
                light = frame[site] - light / n;
            else if (weights[last + site] > 0)
                light = (weights[last + site] * frame[site] - light) / squares[last + site];
        }
    }
    spread(measurements, lack, lack);
    for (std::size_t i = 0; i < x.voxels(); ++i) x.data()[i] += lack[i];
}

std::vector<float> centre_slots(std::span<const FrameExposure> exposures) {
    std::vector<float> centres;
    for (const FrameExposure& exposure : exposures) centres.push_back(exposure.centre_slot);
    return centres;
}

SampleNoise noise_of_frames(Calibration calibration, std::span<const FrameExposure> exposures) {
    calibration.electrons_per_unit *= exposures.front().open_slots;
    return SampleNoise(calibration);
}

FluxVideo video_of_frames(const Measurements& measurements,
                          std::span<const FrameExposure> exposures, const FluxVideo& frames) {
    if (frames.slots() == measurements.slots) return frames;
    FluxVideo x = interpolate_frames(frames, centre_slots(exposures), measurements.slots);
    back_project_residual(measurements, exposures, frames, x);
    return x;
}

}  // namespace stipple
