#include "tests/pipeline/chip_sites.h"

namespace stipple {

ChipEstimate calibrated_chip(const SensorParams& sensor, FrameShape shape,
                             const CalibrationImages& images) {
    FieldSamples dark(shape), flat(shape);
    for (const CalibrationExposure& exposure : calibration_exposures(sensor, images, 1)) {
        SensorParams timed = sensor;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, shape);
        FieldCollector collector(field.header(), exposure.photons > 0 ? flat : dark);
        for (int i = 0; i < exposure.images; ++i) collector.add(field.expose(exposure.photons));
    }
    const StreamHeader header = FlatField(sensor, 1, shape).header();
    return estimate_chip({.header = header, .dark = dark, .flats = {&flat, 1}});
}

SensorParams without_fixed_pattern(SensorParams sensor) {
    PhysicalTerms& terms = sensor.physical;
    terms.prnu = 0;
    terms.dsnu_e = 0;
    terms.column_noise_e = 0;
    terms.read_noise_spread = 0;
    terms.hot_pixel_fraction = 0;
    terms.dead_pixel_fraction = 0;
    terms.response_loss = 0;
    return sensor;
}

}  // namespace stipple
