#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace stipple {

struct Measurements;

/// One sample of a site and the slots of its exposure.
struct TimedSample {
    std::uint64_t open_slots = 0;  ///< bit i: open in slot first_slot + i; bit 0 is set
    int first_slot = 0;            ///< of the block
    int span_slots = 0;            ///< from the first open slot to the last one
    float light_slots = 0;         ///< sum of the weights of the open slots; or their number
    float light = 0;               ///< y, of the whole exposure
    bool saturated = false;        ///< `light` is a lower bound
};

/// The samples of a block, indexed by (site, slot). A site is (plane, row, col) as one index.
class ExposureTable {
  public:
    explicit ExposureTable(const Measurements& measurements);

    [[nodiscard]] int slots() const { return slots_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] float max_light_slots() const { return most_light_slots_; }

    /// Weights of a site from a slot on; null without weights.
    [[nodiscard]] const float* weights(std::size_t site, int slot) const {
        const std::size_t i =
            site * static_cast<std::size_t>(slots_) + static_cast<std::size_t>(slot);
        return weights_.empty() ? nullptr : &weights_[i];
    }

    /// The sample that contains the light of a site in a slot, or null. Precondition: both are in
    /// the block.
    [[nodiscard]] const TimedSample* at(std::size_t site, int slot) const {
        const std::uint32_t i =
            index_[site * static_cast<std::size_t>(slots_) + static_cast<std::size_t>(slot)];
        return i == kNone ? nullptr : &samples_[i];
    }

  private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    int slots_;
    FrameShape shape_;
    float most_light_slots_ = 0;
    std::vector<TimedSample> samples_;
    std::vector<std::uint32_t> index_;  ///< order (site, slot)
    std::vector<float> weights_;        ///< in the same order; empty without weights
};

/// `open_slots` relative to a first slot that is `slots` later: earlier bits are dropped.
[[nodiscard]] constexpr std::uint64_t shift_mask(std::uint64_t open_slots, int slots) {
    if (slots <= -64 || slots >= 64) return 0;
    return slots >= 0 ? open_slots >> static_cast<unsigned>(slots)
                      : open_slots << static_cast<unsigned>(-slots);
}

/// The first `slots` bits, 0..64.
[[nodiscard]] constexpr std::uint64_t lowest_bits(int slots) {
    return slots >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(slots)) - 1;
}

}  // namespace stipple
