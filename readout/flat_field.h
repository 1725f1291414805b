#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry.h"
#include "sensor_model/sensor_params.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Images of uniform light.
struct FlatFieldExposure {
    double photons = 0;  ///< mean photons per pixel and image; 0: dark
    int images = 0;      ///< their number
};

/// The series of an evaluation by EMVA 1288: a dark pair, 50 bright pairs in equal steps up to 1.15
/// of saturation, 100 images at half of saturation, 100 dark ones.
[[nodiscard]] std::vector<FlatFieldExposure> flat_field_exposures(const SensorParams& params);

/// A series of images for the calibration of a chip.
struct CalibrationExposure {
    double slot_us = 0;  ///< exposure time
    double photons = 0;  ///< mean photons per pixel and image; 0: dark
    int images = 0;
    std::uint64_t seed = 0;  ///< of their noise
};

/// Numbers of images.
struct CalibrationImages {
    int darks = 100;  ///< of each exposure time
    int flats = 100;
    int levels = 0;  ///< of light, for the response curve; 0: none
};

/// Images without light in one slot and as many in 16 slots; flats at half of saturation in one
/// slot. Levels: exposure times at the light of the flats, in equal steps up to 0.9 of saturation,
/// each with a tenth of the flats, eight at least. The noise is not that of a stream with the same
/// `seed`.
[[nodiscard]] std::vector<CalibrationExposure> calibration_exposures(
    const SensorParams& params, const CalibrationImages& images, std::uint64_t seed);

/// An emulated sensor in front of a field that is lit uniformly: one slot an image, the whole array
/// read in each.
class FlatField {
  public:
    static constexpr FrameShape kShape{.rows = 240, .cols = 320, .planes = 1};

    /// A colour filter array of `params` is removed; `header` still tells it. \throws InputError if
    /// the sensor has maps of unequal pixels.
    FlatField(SensorParams params, std::uint64_t seed, FrameShape shape = kShape);
    ~FlatField();
    FlatField(const FlatField&) = delete;
    FlatField& operator=(const FlatField&) = delete;

    /// The DN of the next image, by row and column; valid until the next call.
    [[nodiscard]] const std::vector<std::uint16_t>& capture(double photons);
    /// The next image as a slot of a stream; valid until the next call.
    [[nodiscard]] const SamplePacket& expose(double photons);
    /// Of this stream, without provenance.
    [[nodiscard]] const StreamHeader& header() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
