#include "decoder/fast/pseudo_samples.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/fast/box_blur.h"
#include "decoder/measurements.h"
#include "decoder/naive/site_exposures.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

/// Variance, in squared changes of light: of a voxel in no sample, and of a saturated one.
constexpr float kUnsampledDoubt = 8;
constexpr float kSaturatedDoubt = 0.7F;

/// Slots in which no site of any sensor collects light.
std::vector<bool> closed_slots(const Measurements& measurements) {
    std::vector<bool> closed(index(measurements.slots), true);
    for_each_sensor(measurements, [&](const Measurements& m) {
        for (std::size_t slot = 0; slot < closed.size(); ++slot)
            closed[slot] =
                closed[slot] &&
                std::ranges::none_of(
                    std::span(m.state).subspan(slot * m.shape.sites(), m.shape.sites()),
                    [](std::uint8_t state) { return (state & Measurements::kOpen) != 0; });
    });
    return closed;
}

/// Squared changes of light at the voxels, where they are known, and the slots that nobody sees.
struct Changes {
    std::vector<float> squared;
    std::vector<float> known;  ///< 0 or 1
    std::vector<bool> closed_slots;

    void raise(std::size_t voxel, float value) {
        squared[voxel] = known[voxel] == 0 ? value : std::max(squared[voxel], value);
        known[voxel] = 1;
    }
};

class SitePresumption {
  public:
    SitePresumption(Measurements& measurements, const FluxVideo& nearest, const SampleNoise& noise,
                    Changes& changes)
        : m_(measurements), nearest_(nearest.data()), noise_(noise), changes_(changes) {}
    [[nodiscard]] const std::vector<PseudoSamples::Bound>& bounds() const { return bounds_; }

    /// Of the next site, before any is added to.
    void note_changes(std::size_t site) {
        list_all_exposures(m_, site, exposures_);
        note_known_changes(site);
        for (std::size_t k = 1; k < exposures_.size(); ++k) {
            const SiteExposure& a = exposures_[k - 1];
            const SiteExposure& b = exposures_[k];
            if (a.saturated == b.saturated) continue;
            const float change = a.saturated ? a.light_per_slot - b.light_per_slot
                                             : b.light_per_slot - a.light_per_slot;
            if (change > 0) raise(site, a.first_slot, b.last_slot, change * change);
        }
    }
    /// True if closed slots of an exposure have become samples of the second chain.
    bool presume(std::size_t site) {
        list_exposures(m_, site, exposures_);
        if (exposures_.empty()) return false;
        if (m_.others.empty()) settle_saturated(site);
        return !m_.interleaved && fill_unsampled(site);
    }

  private:
    [[nodiscard]] std::size_t voxel(std::size_t site, int slot) const {
        return index(slot) * m_.shape.sites() + site;
    }
    void raise(std::size_t site, int first_slot, int last_slot, float squared_change) {
        for (int slot = first_slot; slot <= last_slot; ++slot)
            changes_.raise(voxel(site, slot), squared_change);
    }

    /// From an unsaturated sample to the next; before the first and after the last as next to it.
    void note_known_changes(std::size_t site) {
        const SiteExposure* before = nullptr;
        int begin = 0;
        float squared = 0;
        bool any = false;
        for (const SiteExposure& e : exposures_) {
            if (e.saturated) continue;
            if (before != nullptr) {
                const float change = e.light_per_slot - before->light_per_slot;
                squared = change * change - e.variance_per_slot - before->variance_per_slot;
                raise(site, begin, e.last_slot, squared);
                begin = before->last_slot;
                any = true;
            }
            before = &e;
        }
        if (any) raise(site, begin, m_.slots - 1, squared);
    }

    [[nodiscard]] bool has_gaps() const {
        for (std::size_t k = 1; k < exposures_.size(); ++k)
            if (exposures_[k].first_slot > exposures_[k - 1].last_slot + 1) return true;
        return false;
    }

    /// By any sensor.
    [[nodiscard]] bool is_sampled(std::size_t voxel) const {
        const auto open = [&](const Measurements& m) {
            return (m.state[voxel] & Measurements::kOpen) != 0;
        };
        return open(m_) || std::ranges::any_of(m_.others, open);
    }

    /// Where there are no gaps, what is unsampled at both ends are exposures that were cut off
    /// there: a few slots, in which the prior knows more of what moves.
    bool fill_unsampled(std::size_t site) {
        const bool gaps = has_gaps();
        const int begin = gaps ? 0 : exposures_.front().first_slot;
        const int end = gaps ? m_.slots : exposures_.back().last_slot + 1;
        bool closed = false;
        auto next = exposures_.begin();
        for (int slot = begin; slot < end; ++slot) {
            while (next != exposures_.end() && next->last_slot < slot) ++next;
            const std::size_t i = voxel(site, slot);
            if (is_sampled(i)) continue;
            const bool within = next != exposures_.end() && next->first_slot < slot;
            if (within && !changes_.closed_slots[index(slot)]) continue;
            closed = closed || within;
            make_sample(i, within ? Measurements::kSecond : std::uint8_t{0});
        }
        return closed;
    }

    void make_sample(std::size_t i, std::uint8_t chain) {
        m_.state[i] = Measurements::kOpen | Measurements::kFirst | Measurements::kLast |
                      Measurements::kPseudo | chain;
        m_.sum[i] = nearest_[i];
        m_.variance[i] = noise_.variance(m_.sum[i]) + kUnsampledDoubt * changes_.squared[i];
    }

    void settle_saturated(std::size_t site) {
        const auto known = [](const SiteExposure& e) { return !e.saturated; };
        const SiteExposure* before = nullptr;
        for (auto e = exposures_.begin(); e != exposures_.end(); ++e) {
            if (!e->saturated) {
                before = &*e;
                continue;
            }
            const auto after = std::find_if(e, exposures_.end(), known);
            if (before == nullptr || after == exposures_.end())
                raise_bound(site, *e);
            else if (std::min(before->light_per_slot, after->light_per_slot) >= e->light_per_slot)
                make_known(site, *e);
        }
    }

    struct PseudoSample {
        float light = 0;
        float variance = 0;  ///< of its changes
    };
    [[nodiscard]] PseudoSample pseudo_sample(std::size_t site, const SiteExposure& e) const {
        PseudoSample p;
        float change = 0;
        for (int slot = e.first_slot; slot <= e.last_slot; ++slot) {
            const std::size_t i = voxel(site, slot);
            if ((m_.state[i] & Measurements::kOpen) == 0) continue;
            p.light += m_.weight_at(i) * nearest_[i];
            change = std::max(change, changes_.squared[i]);
        }
        p.variance = kSaturatedDoubt * e.light_slots * e.light_slots * change;
        return p;
    }

    void raise_bound(std::size_t site, const SiteExposure& e) {
        const PseudoSample p = pseudo_sample(site, e);
        raise_sum(voxel(site, e.last_slot), p.light - 2 * std::sqrt(p.variance));
    }

    void make_known(std::size_t site, const SiteExposure& e) {
        const PseudoSample p = pseudo_sample(site, e);
        const std::size_t i = voxel(site, e.last_slot);
        raise_sum(i, p.light);
        m_.state[i] = static_cast<std::uint8_t>((m_.state[i] & ~Measurements::kSaturated) |
                                                Measurements::kPseudo);
        const float noise =
            m_.dark_variance.empty() ? noise_.variance(m_.sum[i]) : m_.variance_at(i, m_.sum[i]);
        m_.variance[i] = noise + p.variance;
    }

    void raise_sum(std::size_t i, float bound) {
        bounds_.push_back({i, m_.sum[i]});
        m_.sum[i] = std::max(m_.sum[i], bound);
    }

    Measurements& m_;
    std::span<const float> nearest_;
    const SampleNoise& noise_;
    Changes& changes_;
    std::vector<SiteExposure> exposures_;
    std::vector<PseudoSamples::Bound> bounds_;
};

/// Each squared change becomes the mean of those known around it; not negative.
void pool(const Measurements& m, Changes& changes) {
    const std::size_t pixels = m.shape.pixels();
    parallel_for(0, m.slots * m.shape.planes, [&](int plane) {
        const auto squared = std::span(changes.squared).subspan(index(plane) * pixels, pixels);
        const auto known = std::span(changes.known).subspan(index(plane) * pixels, pixels);
        box_blur(m.shape, squared);
        box_blur(m.shape, known);
        for (std::size_t i = 0; i < pixels; ++i)
            squared[i] = known[i] > 0 ? std::max(0.0F, squared[i] / known[i]) : 0;
    });
}

}  // namespace

PseudoSamples::PseudoSamples(Measurements& measurements, const FluxVideo& nearest,
                             const SampleNoise& noise)
    : measurements_(measurements), interleaved_(measurements.interleaved) {
    Changes changes{std::vector<float>(measurements.voxels()),
                    std::vector<float>(measurements.voxels()), closed_slots(measurements)};
    const FrameShape shape = measurements.shape;
    std::vector<SitePresumption> rows(index(shape.planes * shape.rows),
                                      SitePresumption(measurements, nearest, noise, changes));
    const auto for_each_site = [&](const auto& body) {
        parallel_for(0, shape.planes * shape.rows, [&](int row) {
            const std::size_t begin = index(row) * index(shape.cols);
            for (std::size_t site = begin; site < begin + index(shape.cols); ++site)
                body(rows[index(row)], site);
        });
    };
    for_each_site([](SitePresumption& row, std::size_t site) { row.note_changes(site); });
    pool(measurements, changes);
    std::atomic<bool> closed = false;
    for_each_site([&](SitePresumption& row, std::size_t site) {
        if (row.presume(site)) closed = true;
    });
    measurements.interleaved = measurements.interleaved || closed;
    for (const SitePresumption& row : rows)
        bounds_.insert(bounds_.end(), row.bounds().begin(), row.bounds().end());
}

PseudoSamples::~PseudoSamples() {
    Measurements& m = measurements_;
    for (const Bound& bound : bounds_) {
        m.sum[bound.voxel] = bound.sum;
        m.state[bound.voxel] = static_cast<std::uint8_t>(
            (m.state[bound.voxel] | Measurements::kSaturated) & ~Measurements::kPseudo);
    }
    for (std::size_t i = 0; i < m.voxels(); ++i)
        if ((m.state[i] & Measurements::kPseudo) != 0) {
            m.state[i] = 0;
            m.sum[i] = m.variance[i] = 0;
        }
    m.interleaved = interleaved_;
}

}  // namespace stipple
