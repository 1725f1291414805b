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
#include "python/footage.h"
#include "python/sensor.h"
#include "readout/flat_field.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "study/calibration/field_series.h"

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

/// The number `name`. \throws InputError if it is outside [min, max].
int number_in(const py::dict& numbers, const char* name, std::uint64_t min, std::uint64_t max) {
    const std::uint64_t number = whole_in(numbers[name], name);
    if (number < min || number > max)
        throw InputError(name, fmt::format("{} is outside {}..{}", number, min, max));
    return static_cast<int>(number);
}

/// "size" and "planes". \throws InputError for what `stipple calibrate` refuses.
FrameShape shape_in(const py::dict& numbers) {
    const auto [rows, cols] = size_in(numbers["size"], "size");
    if (rows < 1 || cols < 1 || rows > kMaxFrameSide || cols > kMaxFrameSide)
        throw InputError(
            "size", fmt::format("({}, {}) is outside 1..{}, for both", rows, cols, kMaxFrameSide));
    return {.rows = static_cast<int>(rows),
            .cols = static_cast<int>(cols),
            .planes = number_in(numbers, "planes", 1, 4)};
}

/// "flats", "darks" and "levels", likewise.
CalibrationImages images_in(const py::dict& numbers, const SensorParams& params) {
    return {.darks = number_in(numbers, "darks", 1, 65535),
            .flats = number_in(numbers, "flats", 1, 65535),
            .levels = numbers["levels"].is_none() ? default_levels(params)
                                                  : number_in(numbers, "levels", 0, 1000)};
}

/// Thrown out of a calibration that Python ends.
struct CalibrationEnded {};

/// A calibration that goes to a file.
class CalibrationTask {
  public:
    CalibrationTask(const fs::path& output, bool force, bool dark_current)
        : output_(creating(output, [&] { return std::make_unique<PendingOutput>(output, force); })),
          dark_current_(dark_current) {}

    py::dict of_sensor(const py::object& sensor, const py::dict& numbers, const py::object& tell) {
        const ChosenSensor chosen = sensor_of(sensor);
        const SensorParams& params = chosen.description.params;
        const EmulatedSeries series{.params = params,
                                    .shape = shape_in(numbers),
                                    .sensor = chosen.choice.sensor,
                                    .size_where = "size"};
        const auto exposures = calibration_exposures(params, images_in(numbers, params),
                                                     whole_in(numbers["seed"], "seed"));
        std::int64_t images = 0;
        for (const CalibrationExposure& exposure : exposures) images += exposure.images;
        return run(tell, {images}, [&](const SeriesObserver& observer) {
            return expose_series(series, exposures, observer);
        });
    }

    py::dict of_images(const fs::path& descriptor, const py::object& tell) {
        return reading(descriptor, [&] {
            return run(tell, {}, [&](const SeriesObserver& observer) {
                return read_image_series(descriptor, observer);
            });
        });
    }

    py::dict of_streams(const Files& dark, const Files& flat, const py::object& tell) {
        for (const Files& files : {dark, flat})
            for (const fs::path& file : files)
                reading(file, [&] { return StreamReader(file).slots(); });
        return run(tell, {.step = 0}, [&](const SeriesObserver& observer) {
            return read_field_streams(dark, flat, observer);
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
    /// How a series counts for the progress.
    struct Images {
        std::optional<std::int64_t> count = {};  ///< none: unknown
        double step = 1;                         ///< of an image or packet
    };

    /// Of the fields that `take` gives, without the GIL.
    template <typename Take>
    py::dict run(const py::object& tell, const Images& images, const Take& take) {
        CallProgress progress(tell, images.count);
        std::optional<ChipEstimate> estimate;
        std::vector<std::string> warnings;
        double done = 0;
        const SeriesObserver observer{
            .advance =
                [&] {
                    done += images.step;
                    if (!progress.reach(done)) throw CalibrationEnded{};
                },
            .warn = [&](const std::string& text) { warnings.push_back(text); }};
        try {
            const py::gil_scoped_release released;
            estimate = estimate_series(take(observer), dark_current_);
        } catch (const CalibrationEnded&) {  // `finish` raises why
        }
        progress.finish();
        for (const std::string& text : warnings) warn(text);
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
