#pragma once

#include <array>
#include <cstdint>

#include "core/named_value.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Where the charge or the signals of n x n pixels are added (docs/explore.md).
enum class BinningMode : std::uint8_t {
    kCharge,   ///< at a shared sense node: one reading
    kVoltage,  ///< behind the pixels: the noise of n x n readings adds in power
};

inline constexpr auto kBinningModes = std::to_array<NamedValue<BinningMode>>(
    {{"charge", BinningMode::kCharge}, {"voltage", BinningMode::kVoltage}});

inline constexpr int kMaxBinning = 8;

/// The sensor whose pixels are the sums of n x n pixels of `params`: n^2 times the light, the full
/// well and the full scale. \throws InputError unless 1 <= n <= kMaxBinning, if a parameter leaves
/// its range, and for a colour filter array and maps of pixels, which do not add.
[[nodiscard]] SensorParams binned(SensorParams params, int n, BinningMode mode);

}  // namespace stipple
