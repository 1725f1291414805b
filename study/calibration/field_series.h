#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/chip_calibration.h"
#include "calibration/chip_estimate.h"
#include "calibration/field_samples.h"
#include "calibration/response_fit.h"
#include "core/geometry.h"
#include "readout/flat_field.h"
#include "stream/stream_header.h"

namespace stipple {

/// The samples for a calibration, and of which chip they are.
struct FieldSeries {
    StreamHeader header;
    FieldSamples dark;
    std::vector<FieldSamples> flats;
    std::vector<ResponseLevel> levels = {};  ///< empty: as those of `flats`
    std::string dark_name;
    std::string flat_name;
    ChipIdentity chip = {};
    bool well_known = true;
};

/// What a series tells while it is taken. What the functions throw ends it.
struct SeriesObserver {
    std::function<void()> advance;                 ///< after each image or packet
    std::function<void(const std::string&)> warn;  ///< of damaged streams
};

/// A series of an emulated sensor.
struct EmulatedSeries {
    const SensorParams& params;
    FrameShape shape;
    std::string_view sensor;      ///< its name, in messages
    std::string_view size_where;  ///< where the shape was given, likewise
};

/// Levels of light that tell the response curve of a sensor, if it has one that is not linear.
[[nodiscard]] int default_levels(const SensorParams& params);

// \throws InputError as the readers of streams and images, and as check_memory.

[[nodiscard]] FieldSeries expose_series(const EmulatedSeries& series,
                                        const std::vector<CalibrationExposure>& exposures,
                                        const SeriesObserver& observer);
/// The dark groups of the images of a camera, and the bright group that has the most.
[[nodiscard]] FieldSeries read_image_series(const std::filesystem::path& descriptor,
                                            const SeriesObserver& observer);
/// Streams of a chip. Preconditions: neither list is empty.
[[nodiscard]] FieldSeries read_field_streams(const std::vector<std::filesystem::path>& dark,
                                             const std::vector<std::filesystem::path>& flat,
                                             const SeriesObserver& observer);

/// estimate_chip with the identity of the chip.
[[nodiscard]] ChipEstimate estimate_series(const FieldSeries& series, bool dark_current);

}  // namespace stipple
