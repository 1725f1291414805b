#include "decoder/joint/joint_measurements.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"

namespace stipple {
namespace {

constexpr std::uint8_t kChain = Measurements::kSecond;

bool is_last(const Measurements& m, std::size_t voxel) {
    return (m.state[voxel] & Measurements::kLast) != 0;
}

/// Of the exposure that a voxel of state `of` belongs to.
bool is_open(const Measurements& m, std::size_t voxel, std::uint8_t of) {
    return (m.state[voxel] & Measurements::kOpen) != 0 && ((m.state[voxel] ^ of) & kChain) == 0;
}

/// True if the exposures that end at `last` are open in the same slots.
bool have_same_slots(const Measurements& a, const Measurements& b, std::size_t last) {
    const std::size_t sites = a.shape.sites();
    for (std::size_t voxel = last;; voxel -= sites) {
        const bool open = is_open(a, voxel, a.state[last]);
        if (open != is_open(b, voxel, b.state[last])) return false;
        const auto begins = [&](const Measurements& m) {
            return (m.state[voxel] & Measurements::kFirst) != 0;
        };
        if (!open) continue;
        if (begins(a) != begins(b)) return false;
        if (begins(a)) return true;
    }
}

void remove(Measurements& m, std::size_t last) {
    const std::uint8_t of = m.state[last];
    for (std::size_t voxel = last;; voxel -= m.shape.sites()) {
        if (!is_open(m, voxel, of)) continue;
        const bool first = (m.state[voxel] & Measurements::kFirst) != 0;
        m.state[voxel] = 0;
        if (first) break;
    }
    m.sum[last] = m.variance[last] = 0;
    m.dark_variance[last] = m.variance_per_light[last] = 0;
}

/// The sample of b in place of that of a.
void take(Measurements& a, const Measurements& b, std::size_t last) {
    constexpr int kOfSample = Measurements::kSaturated | Measurements::kZero;
    a.state[last] =
        static_cast<std::uint8_t>((a.state[last] & ~kOfSample) | (b.state[last] & kOfSample));
    a.sum[last] = b.sum[last];
    a.variance[last] = b.variance[last];
    a.dark_variance[last] = b.dark_variance[last];
    a.variance_per_light[last] = b.variance_per_light[last];
}

/// Neither is saturated.
void average(Measurements& a, const Measurements& b, std::size_t last) {
    // Photons per unit of light are the inverse of the variance per light.
    const float photons_a = 1 / a.variance_per_light[last];
    const float photons_b = 1 / b.variance_per_light[last];
    const float light =
        (photons_a * a.sum[last] + photons_b * b.sum[last]) / (photons_a + photons_b);
    const float variance_a = a.variance_at(last, light);
    const float variance_b = b.variance_at(last, light);
    const float weight = variance_b / (variance_a + variance_b);
    const float rest = variance_a / (variance_a + variance_b);
    const auto of_mean = [&](float of_a, float of_b) {
        return weight * weight * of_a + rest * rest * of_b;
    };
    a.sum[last] = weight * a.sum[last] + rest * b.sum[last];
    a.dark_variance[last] = of_mean(a.dark_variance[last], b.dark_variance[last]);
    a.variance_per_light[last] = of_mean(a.variance_per_light[last], b.variance_per_light[last]);
    a.variance[last] = a.variance_at(last, a.sum[last]);
    if ((b.state[last] & Measurements::kZero) == 0)
        a.state[last] = static_cast<std::uint8_t>(a.state[last] & ~Measurements::kZero);
}

void merge(Measurements& a, Measurements& b, std::size_t last) {
    const auto saturated = [&](const Measurements& m) {
        return (m.state[last] & Measurements::kSaturated) != 0;
    };
    const bool takes_b = saturated(a) && (!saturated(b) || b.sum[last] > a.sum[last]);
    if (takes_b)
        take(a, b, last);
    else if (!saturated(a) && !saturated(b))
        average(a, b, last);
    remove(b, last);
}

/// Of all sites of a row of a plane.
void merge_row(Measurements& a, Measurements& b, int row) {
    const std::size_t begin = index(row) * index(a.shape.cols);
    for (int slot = 0; slot < a.slots; ++slot)
        for (std::size_t site = begin; site < begin + index(a.shape.cols); ++site) {
            const std::size_t voxel = index(slot) * a.shape.sites() + site;
            if (is_last(a, voxel) && is_last(b, voxel) && have_same_slots(a, b, voxel))
                merge(a, b, voxel);
        }
}

void merge_two(Measurements& a, Measurements& b) {
    if (!a.weight.empty() || !b.weight.empty()) return;
    parallel_for(0, a.shape.planes * a.shape.rows, [&](int row) { merge_row(a, b, row); });
}

bool is_empty(const Measurements& m) {
    return std::ranges::none_of(
        m.state, [](std::uint8_t state) { return (state & Measurements::kOpen) != 0; });
}

}  // namespace

void merge_equal_exposures(Measurements& measurements) {
    std::vector<Measurements>& others = measurements.others;
    for (std::size_t i = 0; i < others.size(); ++i) {
        merge_two(measurements, others[i]);
        for (std::size_t k = 0; k < i; ++k) merge_two(others[k], others[i]);
    }
    std::erase_if(others, is_empty);
}

}  // namespace stipple
