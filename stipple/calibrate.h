#pragma once

/// Calibration of the pixels of a chip from dark and flat-field series (docs/calibration.md), here
/// of an emulated one:
///
///     stipple::SensorParams sensor = stipple::set_up_params({.sensor = "t6"});
///     const stipple::FrameShape shape{.rows = 48, .cols = 64, .planes = 1};
///     stipple::FieldSamples dark(shape), flat(shape);
///     std::optional<stipple::StreamHeader> header;
///     for (const auto& series : stipple::calibration_exposures(sensor, {}, 1)) {
///         sensor.slot_us = series.slot_us;
///         stipple::FlatField field(sensor, series.seed, shape);
///         stipple::FieldCollector collector(field.header(), series.photons > 0 ? flat : dark);
///         for (int image = 0; image < series.images; ++image)
///             collector.add(field.expose(series.photons));
///         header = field.header();
///     }
///     const std::vector flats{flat};
///     const stipple::ChipEstimate chip =
///         stipple::estimate_chip({.header = *header, .dark = dark, .flats = flats});
///     std::cout << chip.defects << " defects\n";
///
/// encode_chip_calibration writes the file that DecodeSession finds beside a stream.
#include "calibration/calibration_file.h"
#include "calibration/chip_estimate.h"
#include "readout/flat_field.h"
#include "stipple/sensor.h"
