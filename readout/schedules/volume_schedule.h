#pragma once

#include <string_view>

#include "core/exposure_schedule.h"
#include "io/npy_volume.h"

namespace stipple {

/// The schedule of a volume of binary masks, one layer per slot: each pixel repeats one exposure,
/// open where its mask is 1 or, in a volume that holds 255, where it is 255; a pixel whose mask is
/// 0 throughout is never read. \throws InputError at `where`, naming pixel and slot, for any other
/// value and for an exposure that spans more than 64 slots.
[[nodiscard]] ExposureSchedule mask_schedule(const NpyVolume& masks, std::string_view where);

/// The schedule of a volume of exposure lengths in slots: each pixel repeats its layers' exposures
/// one after the other from slot 0 on; a length of 0 is none. The period is `period_slots` or, if
/// that is 0, the largest sum of a pixel.
/// \throws InputError at `where`, naming pixel and exposure, for a value that is no whole number of
/// 0..64 and for a pixel whose sum is longer than the period; if the period is beyond 65535.
[[nodiscard]] ExposureSchedule lengths_schedule(const NpyVolume& lengths, int period_slots,
                                                std::string_view where);

}  // namespace stipple
