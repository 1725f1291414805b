#pragma once

#include <pybind11/pytypes.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/chip_calibration.h"
#include "calibration/field_samples.h"
#include "calibration/response_fit.h"
#include "core/geometry.h"
#include "core/message.h"
#include "python/call_progress.h"
#include "python/sensor.h"
#include "readout/flat_field.h"
#include "stream/stream_header.h"

namespace stipple::python {

/// The samples for a calibration, and of which chip they are.
struct FieldSeries {
    StreamHeader header;
    FieldSamples dark;
    std::vector<FieldSamples> flats;
    std::string dark_name;
    std::string flat_name;
    std::vector<ResponseLevel> levels = {};  ///< empty: as those of `flats`
    ChipIdentity chip = {};
    bool well_known = true;
    std::vector<Message> warnings = {};  ///< of damaged streams
};

/// A series of an emulated sensor.
struct EmulatedSeries {
    ChosenSensor sensor;
    FrameShape shape;
    CalibrationImages images;
    std::uint64_t seed = 1;
};

/// Of "size", "planes", "flats", "darks", "levels" and "seed". \throws InputError as `sensor_of`,
/// and for numbers that `stipple calibrate` refuses.
[[nodiscard]] EmulatedSeries emulated_series(const pybind11::object& sensor,
                                             const pybind11::dict& numbers);

/// Thrown out of a calibration that Python ends.
struct CalibrationEnded {};

/// The following tell `progress` of each image or packet, without the GIL. \throws
/// CalibrationEnded, InputError.
[[nodiscard]] FieldSeries expose_series(const EmulatedSeries& series,
                                        const std::vector<CalibrationExposure>& exposures,
                                        CallProgress& progress);
/// Images of a camera.
[[nodiscard]] FieldSeries read_image_series(const std::filesystem::path& descriptor,
                                            CallProgress& progress);
/// Preconditions: neither is empty.
[[nodiscard]] FieldSeries read_field_streams(const std::vector<std::filesystem::path>& dark,
                                             const std::vector<std::filesystem::path>& flat,
                                             CallProgress& progress);

}  // namespace stipple::python
