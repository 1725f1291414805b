#pragma once

#include <cstdint>
#include <span>

#include "decoder/forward_model.h"
#include "readout/sensor_file.h"

namespace stipple {

/// The samples that a sensor takes of a window of light, order (slot, plane, row, col) of
/// setup.footage, reset before its first slot; `seed` is that of the noise. They are those of the
/// stream that an Emulator with this seed makes, of all slots: what a timing says is not asked.
/// Uses the calling thread only. \throws InputError as CodedSensor and ForwardModel.
[[nodiscard]] ForwardModel samples_of_light(const SensorSetup& setup, std::uint64_t seed,
                                            std::span<const float> light);

}  // namespace stipple
