#pragma once

#include <cstddef>
#include <cstdint>

#include "core/philox.h"

namespace stipple {

/// Whose random numbers: each generator of schedules has its own. 0 is `random_schedule`.
enum class DrawPlane : std::uint32_t {
    kTiled = 1,
    kScattered = 2,
    kFlutter = 3,
    kHardwareTiled = 4
};

/// Random numbers one after the other, for the making of schedules.
class Draws {
  public:
    Draws(std::uint64_t seed, DrawPlane plane)
        : seed_(seed), plane_(static_cast<std::uint32_t>(plane)) {}

    /// An integer in [0, range).
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

}  // namespace stipple
