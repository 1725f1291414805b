#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/philox.h"

namespace stipple {

/// Plane of the random counter (`random_address`) for each generator of schedules, so that each has
/// its own sequence. `random_schedule` uses plane 0.
enum class DrawPlane : std::uint32_t {
    kTiled = 1,
    kScattered = 2,
    kFlutter = 3,
    kHardwareTiled = 4
};

/// A sequence of random integers for a generator of schedules: word 0 of the Philox blocks
/// (philox.h) of counters 0, 1, ... with key `seed`. The same on any machine.
class Draws {
  public:
    Draws(std::uint64_t seed, DrawPlane plane)
        : seed_(seed), plane_(static_cast<std::uint32_t>(plane)) {}

    /// The next integer, uniform in [0, range): floor(word range / 2^32), so probabilities differ
    /// by at most 2^-32. Precondition: 1 <= range <= 2^32.
    std::uint32_t below(std::size_t range) {
        const auto address = random_address(static_cast<std::uint32_t>(count_),
                                            static_cast<std::uint32_t>(count_ >> 32U),
                                            RandomPurpose::kSchedule, plane_);
        ++count_;
        const std::uint64_t word = philox4x32(address, seed_)[0];
        return static_cast<std::uint32_t>((word * range) >> 32U);
    }

  private:
    std::uint64_t seed_;
    std::uint32_t plane_;
    std::uint64_t count_ = 0;
};

/// Fisher-Yates: all orders are equally likely.
template <typename Value>
void shuffle(std::vector<Value>& values, Draws& draws) {
    for (std::size_t i = values.size(); i > 1; --i)
        std::swap(values[i - 1], values[draws.below(i)]);
}

}  // namespace stipple
