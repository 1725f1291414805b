#pragma once

#include <string_view>

#include "core/exposure_schedule.h"
#include "io/npy_file.h"

namespace stipple {

/// The value of masks that is weight 1: if all are whole numbers and some are above 1, 255 or
/// 65535, as of images of 8 and 16 bits; else 1.
[[nodiscard]] double white_of(const NpyVolume& masks);

/// The schedule of a volume of masks, one layer per slot: each pixel repeats one exposure, open
/// where its mask is not 0. The weights are the values of the masks divided by `white` (0:
/// `white_of`); below 2^-20 they count as 0. A pixel whose mask is 0 throughout is never read.
/// Masks of 0 and `white` only give a schedule without weights. \throws InputError at `where` if
/// all weights are 0; naming pixel and slot, for a weight outside 0..2^20 or NaN and for an
/// exposure that spans more than 64 slots.
[[nodiscard]] ExposureSchedule mask_schedule(const NpyVolume& masks, std::string_view where,
                                             double white = 0);

/// The schedule of a volume of exposure lengths in slots: each pixel repeats its layers' exposures
/// one after the other from slot 0 on; a length of 0 is none. The period is `period_slots` or, if
/// that is 0, the largest sum of a pixel.
/// \throws InputError at `where`, naming pixel and exposure, for a value that is not a whole number
/// of 0..64 and for a pixel whose sum is longer than the period; if the period is beyond 65535.
[[nodiscard]] ExposureSchedule lengths_schedule(const NpyVolume& lengths, int period_slots,
                                                std::string_view where);

}  // namespace stipple
