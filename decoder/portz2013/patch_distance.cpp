#include "decoder/portz2013/patch_distance.h"

#include <limits>

namespace stipple {
namespace {

/// A pixel as a patch meets it: slot 0 is the patch's first.
struct PixelInPatch {
    const ExposureTable& table;
    std::size_t site;
    int slot;

    [[nodiscard]] const TimedSample* at(int offset) const {
        const int i = slot + offset;
        return i >= 0 && i < table.slots() ? table.at(site, i) : nullptr;
    }
    /// Weights from the first slot of a sample of this pixel; null without weights.
    [[nodiscard]] const float* weights(const TimedSample& sample) const {
        return table.weights(site, sample.first_slot);
    }
    /// First slot of a sample of this pixel.
    [[nodiscard]] int offset_of(const TimedSample& sample) const {
        return sample.first_slot - slot;
    }
    /// Slots of the patch that it covers.
    [[nodiscard]] int cover(const TimedSample& sample, int slots) const {
        return std::popcount(shift_mask(sample.open_slots, -offset_of(sample)) &
                             lowest_bits(slots));
    }
};

/// A sample and the weights of its pixel from its first slot on, or null.
struct Target {
    const TimedSample& sample;
    const float* weights;

    /// Sum of the weights of `slots` of its slots.
    [[nodiscard]] float light_slots(std::uint64_t slots) const {
        if (weights == nullptr) return static_cast<float>(std::popcount(slots));
        float sum = 0;
        for (; slots != 0; slots &= slots - 1) sum += weights[std::countr_zero(slots)];
        return sum;
    }
};

/// The light of a target as the samples of another pixel tell it.
struct Blurred {
    float light = 0;
    float variance = 0;
    bool saturated = false;
    bool known = false;
};

Blurred blur_to(const Target& target, int target_offset, const PixelInPatch& source) {
    Blurred z;
    std::uint64_t rest = target.sample.open_slots;
    while (rest != 0) {
        const TimedSample* sample = source.at(target_offset + std::countr_zero(rest));
        if (sample == nullptr) return z;
        const int later = target_offset - source.offset_of(*sample);
        const std::uint64_t shared = shift_mask(sample->open_slots, later) & rest;
        const float weight = target.light_slots(shared) / sample->light_slots;
        z.light += weight * sample->light;
        z.variance += weight * weight;
        z.saturated = z.saturated || sample->saturated;
        rest &= ~shared;
    }
    z.known = true;
    return z;
}

void add_target(const TimedSample& target, int cover, const Blurred& z, SampleDifference& sum) {
    if (!z.known || (target.saturated && z.saturated)) return;
    const float weight = static_cast<float>(cover) / (1 + z.variance);
    const bool explained =
        (target.saturated && z.light >= target.light) || (z.saturated && z.light <= target.light);
    const float residual = explained ? 0 : target.light - z.light;
    sum.error += weight * (residual * residual);
    sum.weight += weight;
    sum.cover += cover;
}

}  // namespace

SampleDifference compare_samples(const ExposureTable& table, const SiteInPatch& first_site,
                                 const SiteInPatch& second_site, int slots) noexcept {
    const PixelInPatch first{table, first_site.site, first_site.slot};
    const PixelInPatch second{table, second_site.site, second_site.slot};
    const TimedSample* last_target = nullptr;
    const TimedSample* last_other_target = nullptr;
    SampleDifference sum;
    for (int offset = 0; offset < slots; ++offset) {
        const TimedSample* a = first.at(offset);
        const TimedSample* b = second.at(offset);
        if (a == nullptr || b == nullptr) continue;
        const int cover_a = first.cover(*a, slots);
        const int cover_b = second.cover(*b, slots);
        const float longer = a->light_slots - b->light_slots;
        if (longer > 0 || (longer == 0 && cover_a >= cover_b)) {
            if (a != last_target)
                add_target(*a, cover_a,
                           blur_to({*a, first.weights(*a)}, first.offset_of(*a), second), sum);
            last_target = a;
        } else {
            if (b != last_other_target)
                add_target(*b, cover_b,
                           blur_to({*b, second.weights(*b)}, second.offset_of(*b), first), sum);
            last_other_target = b;
        }
    }
    return sum;
}

float patch_distance(const ExposureTable& table, const PatchSize& size,
                     const PatchPosition& reference, const PatchPosition& other,
                     float bound) noexcept {
    const FrameShape shape = table.shape();
    const auto site = [&](const PatchPosition& at, int plane, int row) {
        return static_cast<std::size_t>(plane) * shape.pixels() +
               static_cast<std::size_t>(at.row + row) * static_cast<std::size_t>(shape.cols) +
               static_cast<std::size_t>(at.col);
    };
    const int voxels = shape.planes * size.rows * size.cols * size.slots;
    // The targets of either pixel are disjoint, so no weight can exceed twice the patch.
    const float exceeds_bound = bound * 2 * static_cast<float>(voxels);
    SampleDifference sum;
    for (int plane = 0; plane < shape.planes; ++plane)
        for (int row = 0; row < size.rows; ++row) {
            const std::size_t a = site(reference, plane, row);
            const std::size_t b = site(other, plane, row);
            for (int col = 0; col < size.cols; ++col) {
                const auto i = static_cast<std::size_t>(col);
                const SampleDifference pixel = compare_samples(table, {a + i, reference.slot},
                                                               {b + i, other.slot}, size.slots);
                sum.error += pixel.error;
                sum.weight += pixel.weight;
                sum.cover += pixel.cover;
            }
            if (sum.error > exceeds_bound) return std::numeric_limits<float>::infinity();
        }
    if (8 * sum.cover < voxels) return std::numeric_limits<float>::infinity();
    return sum.error / sum.weight;
}

}  // namespace stipple
