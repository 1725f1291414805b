#pragma once

#include <cstdint>
#include <span>

#include "core/philox.h"

namespace stipple {

/// The words of the Philox block at `random_address(pixel, slot, RandomPurpose::kSample, plane)`;
/// kAuxiliary and kDither are not used.
/// They define the bits of every sample (docs/sensor_model.md).
enum class SampleWord : std::uint8_t { kShot = 0, kRead = 1, kAuxiliary = 2, kDither = 3 };

/// The part of the address that all samples of a list share.
struct SampleAddress {
    std::uint64_t seed = 0;
    std::uint32_t slot = 0;   ///< last slot of the exposure, modulo 2^32
    std::uint32_t plane = 0;  ///< below 2^24
};

/// Words kShot and kRead of each pixel of a list: those of `philox4x32`, by SIMD.
/// Precondition: equal lengths.
void sample_words(std::span<const std::uint32_t> pixel, const SampleAddress& address,
                  std::span<std::uint32_t> shot, std::span<std::uint32_t> read) noexcept;

}  // namespace stipple
