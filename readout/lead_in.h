#pragma once

#include <cstdint>

namespace stipple {

struct SensorSetup;

/// Slots that a sensor must be exposed after a reset until its samples are those of a sensor that
/// was exposed since slot 0, bit by bit (docs/scaling.md). `--part` of `emulate` emulates so many
/// before its first slot, and discards their samples.
/// \throws InputError if there is no such number: lag and blooming carry light from one exposure
/// to the next without end.
[[nodiscard]] std::int64_t lead_in_slots(const SensorSetup& setup);

}  // namespace stipple
