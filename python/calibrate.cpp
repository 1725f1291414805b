#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/chip_estimate.h"
#include "calibration/scene_gain.h"
#include "core/error.h"
#include "decoder/decode_method.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/field_series.h"
#include "python/footage.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

using namespace pybind11::literals;
using Files = std::vector<fs::path>;

py::object response_dict(const ResponseFit& response) {
    if (response.levels == 0) return py::none();
    return py::dict("levels"_a = response.levels, "linear"_a = response.table.linear_dn.empty(),
                    "brightest_dn"_a = response.brightest_dn, "bend_dn"_a = response.bend_dn,
                    "error_dn"_a = response.error_dn);
}

py::dict map_dict(const MapFigures& stored, const PatternVariances& p) {
    return py::dict("mean"_a = stored.mean, "deviation"_a = stored.deviation,
                    "pixels"_a = std::sqrt(p.pixels), "rows"_a = std::sqrt(p.rows),
                    "columns"_a = std::sqrt(p.cols), "outliers"_a = p.outliers);
}

/// The keys of "calibrate" in docs/outputs.md.
py::dict figures_of(const ChipEstimate& estimate) {
    const ChipCalibration& c = estimate.calibration;
    const ChipFigures figures = chip_figures(c);
    return py::dict(
        "rows"_a = c.shape.rows, "cols"_a = c.shape.cols, "planes"_a = c.shape.planes,
        "flats"_a = c.flats, "darks"_a = c.darks, "gain"_a = map_dict(figures.gain, estimate.gain),
        "gain_error"_a = figures.gain_error,
        "offset_dn"_a = map_dict(figures.offset_dn, estimate.offset_dn),
        "dark_dn_per_s"_a = map_dict(figures.dark_dn_per_s, estimate.dark_dn_per_s),
        "readout_noise_dn2"_a = map_dict(figures.readout_noise_dn2, estimate.readout_noise_dn2),
        "response"_a = response_dict(estimate.response), "defects"_a = figures.defects);
}

/// A calibration that goes to a file.
class CalibrationTask {
  public:
    CalibrationTask(const fs::path& output, bool force, bool dark_current)
        : output_(creating(output, [&] { return std::make_unique<PendingOutput>(output, force); })),
          dark_current_(dark_current) {}

    py::dict of_sensor(const py::object& sensor, const py::dict& numbers, const py::object& tell) {
        const EmulatedSeries series = emulated_series(sensor, numbers);
        const auto exposures =
            calibration_exposures(series.sensor.description.params, series.images, series.seed);
        std::int64_t images = 0;
        for (const CalibrationExposure& exposure : exposures) images += exposure.images;
        return run(tell, images, [&](CallProgress& progress) {
            return expose_series(series, exposures, progress);
        });
    }

    py::dict of_images(const fs::path& descriptor, const py::object& tell) {
        return reading(descriptor, [&] {
            return run(tell, std::nullopt, [&](CallProgress& progress) {
                return read_image_series(descriptor, progress);
            });
        });
    }

    py::dict of_streams(const Files& dark, const Files& flat, const py::object& tell) {
        for (const Files& files : {dark, flat})
            for (const fs::path& file : files)
                reading(file, [&] { return StreamReader(file).slots(); });
        return run(tell, std::nullopt, [&](CallProgress& progress) {
            return read_field_streams(dark, flat, progress);
        });
    }

    py::dict of_scene(const fs::path& stream, const std::string& method,
                      std::optional<double> given, const py::object& tell) {
        const auto opened = [&] { return std::make_unique<StreamReader>(stream); };
        const auto decoded = reading(stream, opened), samples = reading(stream, opened);
        const ChipOrigin chip = chip_of(decoded->header().provenance);
        if (given && !(*given >= 1e-6 && *given <= 0.5))
            throw InputError("prnu", fmt::format("{} is outside 1e-06..0.5", *given));
        const double prnu = given.value_or(chip.prnu);
        if (!(prnu > 0))
            throw InputError(stream.string(),
                             "does not tell how much the gains of the chip differ; give its PRNU "
                             "with prnu (the data sheet has it)");
        const DecodeOptions options{.method = decode_method_from_name(method)};
        CallProgress progress(tell, decoded->slots());
        std::optional<ChipCalibration> calibration;
        {
            const py::gil_scoped_release released;
            calibration = scene_calibration(*decoded, *samples, options, prnu,
                                            [&](double slots) { return progress.reach(slots); });
        }
        progress.finish();
        if (!undamaged(decoded->report()))
            warn(fmt::format("{}: {}", stream.string(), damage_text(decoded->report())));
        if (chip.name.size() <= kMaxNameBytes) calibration.value().chip.name = chip.name;
        calibration.value().chip.device_id = chip.device_id;
        write(*calibration);
        const FrameShape shape = calibration->shape;
        const MapFigures gain = chip_figures(*calibration).gain;
        return py::dict("rows"_a = shape.rows, "cols"_a = shape.cols, "planes"_a = shape.planes,
                        "gain"_a = py::dict("mean"_a = gain.mean, "deviation"_a = gain.deviation));
    }

  private:
    /// Of the fields that `take` gives, without the GIL.
    template <typename Take>
    py::dict run(const py::object& tell, std::optional<std::int64_t> images, const Take& take) {
        CallProgress progress(tell, images);
        std::optional<ChipEstimate> estimate;
        std::vector<Message> warnings;
        try {
            const py::gil_scoped_release released;
            const FieldSeries fields = take(progress);
            estimate = estimate_chip({.header = fields.header,
                                      .dark = fields.dark,
                                      .flats = fields.flats,
                                      .levels = fields.levels,
                                      .dark_name = fields.dark_name,
                                      .flat_name = fields.flat_name,
                                      .well_known = fields.well_known,
                                      .dark_current = dark_current_});
            estimate->calibration.chip = fields.chip;
            warnings = fields.warnings;
        } catch (const CalibrationEnded&) {  // `finish` raises why
        }
        progress.finish();
        for (const Message& text : warnings) warn(text);
        write(estimate.value().calibration);
        return figures_of(*estimate);
    }

    void write(const ChipCalibration& calibration) {
        const auto bytes = encode_chip_calibration(calibration);
        write_text(*output_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }

    std::unique_ptr<PendingOutput> output_;
    bool dark_current_;
};

}  // namespace

void bind_calibrate(py::module_& module) {
    py::class_<CalibrationTask>(module, "CalibrationTask")
        .def(py::init<const fs::path&, bool, bool>())
        .def("of_sensor", &CalibrationTask::of_sensor)
        .def("of_images", &CalibrationTask::of_images)
        .def("of_streams", &CalibrationTask::of_streams)
        .def("of_scene", &CalibrationTask::of_scene);
}

}  // namespace stipple::python
