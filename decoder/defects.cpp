#include "decoder/measurements.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

constexpr int kMinSamples = 4;
constexpr int kMinNeighbours = 3;
constexpr int kMaxUnsound = 2;
constexpr float kHotTimes = 3;         ///< brighter than every neighbour
constexpr float kDarkErrors = 3;       ///< standard errors that no light may differ from 0
constexpr float kExpectedErrors = 20;  ///< of the light that neighbours have

/// What the samples of a site come to in a block.
struct SiteSum {
    int samples = 0;
    int saturated = 0;
    float light_slots = 0;  ///< sum of the weights of the open slots
    float light = 0;
    float variance = 0;
    float at_least = 0;  ///< the most light per slot that a saturated sample proves

    [[nodiscard]] float error() const { return std::sqrt(variance); }
    [[nodiscard]] bool all_saturated() const { return saturated == samples; }
    [[nodiscard]] bool all_dark() const { return light <= kDarkErrors * error(); }
    [[nodiscard]] bool sound() const { return samples > 0 && !all_saturated() && !all_dark(); }
    /// Light per slot, no less than what is proven.
    [[nodiscard]] float level() const { return std::max(light / light_slots, at_least); }
};

/// Sums of one row of sites; where two chains interleave, their open slots are shared out evenly.
void sum_row(const Measurements& m, std::size_t begin, std::span<SiteSum> row) {
    std::vector<float> open(row.size(), 0);
    for (int slot = 0; slot < m.slots; ++slot) {
        const std::size_t first = index(slot) * m.shape.sites() + begin;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::uint8_t state = m.state[first + i];
            if ((state & Measurements::kOpen) != 0) open[i] += m.weight_at(first + i);
            if ((state & Measurements::kLast) == 0) continue;
            SiteSum& site = row[i];
            ++site.samples;
            site.light_slots += open[i];
            site.light += m.sum[first + i];
            site.variance += m.variance[first + i];
            if ((state & Measurements::kSaturated) != 0) {
                ++site.saturated;
                site.at_least = std::max(site.at_least, m.sum[first + i] / open[i]);
            }
            open[i] = 0;
        }
    }
}

/// The sites around one.
struct Surroundings {
    int with_samples = 0;
    int sound = 0;
    float darkest = 0;  ///< level of the sound ones
    float brightest = 0;
};

Surroundings around(const std::vector<SiteSum>& plane, FrameShape shape, int row, int col) {
    Surroundings result;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, shape.rows - 1); ++r)
        for (int c = std::max(col - 1, 0); c <= std::min(col + 1, shape.cols - 1); ++c) {
            const SiteSum& site = plane[index(r) * index(shape.cols) + index(c)];
            if (site.samples == 0 || (r == row && c == col)) continue;
            ++result.with_samples;
            if (!site.sound()) continue;
            const float level = site.level();
            result.darkest = result.sound == 0 ? level : std::min(result.darkest, level);
            result.brightest = std::max(result.brightest, level);
            ++result.sound;
        }
    return result;
}

bool is_stuck(const SiteSum& site, const Surroundings& beside) {
    if (site.samples < kMinSamples || beside.with_samples < kMinNeighbours) return false;
    if (beside.sound < beside.with_samples - kMaxUnsound) return false;
    if (site.all_saturated()) return site.at_least > kHotTimes * beside.brightest;
    const float expected = beside.darkest * site.light_slots;
    return site.all_dark() && expected > kExpectedErrors * site.error();
}

void mask_site(Measurements& m, std::size_t site) {
    for (int slot = 0; slot < m.slots; ++slot) {
        const std::size_t i = index(slot) * m.shape.sites() + site;
        m.state[i] = 0;
        m.sum[i] = 0;
        m.variance[i] = 0;
        if (!m.weight.empty()) m.weight[i] = 1;
    }
}

}  // namespace

std::size_t mask_defects(Measurements& measurements) {
    const FrameShape shape = measurements.shape;
    const std::size_t cols = index(shape.cols);
    std::vector<SiteSum> plane(shape.pixels());
    std::size_t found = 0;
    for (int p = 0; p < shape.planes; ++p) {
        const std::size_t begin = index(p) * shape.pixels();
        std::ranges::fill(plane, SiteSum{});
        parallel_for(0, shape.rows, [&](int row) {
            const std::size_t first = index(row) * cols;
            sum_row(measurements, begin + first, std::span(plane).subspan(first, cols));
        });
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col) {
                const std::size_t pixel = index(row) * cols + index(col);
                const SiteSum& site = plane[pixel];
                if (site.samples == 0 || site.sound()) continue;
                if (!is_stuck(site, around(plane, shape, row, col))) continue;
                mask_site(measurements, begin + pixel);
                ++found;
            }
    }
    return found;
}

}  // namespace stipple
