#pragma once

#include <cstddef>
#include <cstdint>

#include "core/philox.h"

namespace stipple {

/// Random numbers one after the other, for the making of schedules. Each generator has a `plane` of
/// its own: 0 is `random_schedule`, 1 `tiled_schedule`, 2 `scattered_schedule`, 3
/// `flutter_schedule`, 4 `hardware_tiled_schedule`.
class Draws {
  public:
    Draws(std::uint64_t seed, std::uint32_t plane) : seed_(seed), plane_(plane) {}

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
