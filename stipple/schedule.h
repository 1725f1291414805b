#pragma once

/// Exposure schedules: which pixel opens in which slots and is read when (docs/schedules.md). Those
/// of config/schedules have names; others are made in code, here a tile of 1 x 2 pixels and 4 slots
/// whose left pixel reads each slot, and whose right one exposes 1 slot, then 3:
///
///     using stipple::open_without_gap;
///     const stipple::ExposureSchedule schedule(1, 2, 4, {0, 4, 6},
///                                              {{0, open_without_gap(1)},
///                                               {1, open_without_gap(1)},
///                                               {2, open_without_gap(1)},
///                                               {3, open_without_gap(1)},
///                                               {0, open_without_gap(1)},
///                                               {1, open_without_gap(3)}});
///     std::cout << schedule.light_throughput() << " of the light is collected\n";
#include "core/exposure_schedule.h"
#include "readout/schedules/schedule_catalogue.h"
