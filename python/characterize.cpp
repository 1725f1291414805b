#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/input_file.h"
#include "io/image_file.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/sensor.h"
#include "readout/flat_field.h"
#include "sensor_model/sensor_config.h"
#include "study/metrics/emva1288/series_evaluation.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

using namespace pybind11::literals;
using emva1288::CameraFigures;
using emva1288::Evaluation;
using emva1288::Series;
using emva1288::SeriesImage;

/// Images of one exposure that Python has: (image, row, col).
struct ImageStack {
    double exposure_ns;
    double photons;
    py::array_t<std::uint16_t, py::array::c_style> dn;
};

py::dict figures_dict(const CameraFigures& figures) {
    py::dict dict;
    for (const auto& [key, figure] : emva1288::kNamedFigures)
        dict[py::str(key.data(), key.size())] = figures.*figure;
    return dict;
}

py::dict histogram_dict(const emva1288::DeviationHistogram& histogram) {
    return py::dict("first"_a = histogram.first, "width"_a = histogram.width,
                    "pixels"_a = histogram.pixels, "normal"_a = histogram.normal,
                    "accumulated_width"_a = histogram.accumulated_width,
                    "at_least"_a = histogram.at_least);
}

/// The keys of "characterize" in docs/outputs.md.
py::dict evaluation_dict(const Evaluation& evaluation,
                         const std::optional<CameraFigures>& configured) {
    py::dict dict("measured"_a = figures_dict(evaluation.figures));
    if (configured) dict["configured"] = figures_dict(*configured);
    dict["notes"] = emva1288::figure_notes(evaluation.figures, configured);
    dict["dark_mean_dn"] = evaluation.dark_mean_dn;
    dict["dark_deviation_dn"] = std::sqrt(evaluation.dark_variance_dn2);
    dict["dark_zero_fraction"] = evaluation.dark_zero_fraction;
    dict["biased"] = emva1288::is_biased(evaluation);
    py::array_t<double> points({evaluation.transfer.size(), std::size_t{3}});
    double* value = points.mutable_data();
    for (const emva1288::TransferPoint& point : evaluation.transfer)
        for (const double number : {point.photons, point.mean_dn, point.variance_dn2})
            *value++ = number;
    dict["photon_transfer"] = points;
    dict["saturation_point"] = evaluation.saturation;
    dict["dark_deviations"] = histogram_dict(evaluation.dark_deviations);
    dict["bright_deviations"] = histogram_dict(evaluation.bright_deviations);
    return dict;
}

std::int64_t images_in(const Series& series) {
    std::size_t images = 0;
    for (const emva1288::ImageGroup& group : series.groups) images += group.files.size();
    return static_cast<std::int64_t>(images);
}

/// Thrown out of an evaluation that Python ends.
struct Ended {};

/// Evaluates a series, whose images `take` gives one after the other, without the GIL.
template <typename Take>
Evaluation evaluate_series(const Series& series, const std::string& where, const fs::path& folder,
                           const py::object& tell, const Take& take) {
    CallProgress progress(tell, images_in(series));
    std::optional<Evaluation> evaluation;
    try {
        const py::gil_scoped_release released;
        double done = 0;
        const auto read = [&](const fs::path& file) {
            SeriesImage image = take(file);
            if (!progress.reach(++done)) throw Ended();
            return image;
        };
        evaluation = emva1288::evaluate(series, folder, read, where);
    } catch (const Ended&) {  // `finish` raises why
    }
    progress.finish();
    warn(emva1288::bias_warning(evaluation.value()));
    return *evaluation;
}

py::dict characterize(const py::object& chosen, const py::object& seed, const py::object& tell) {
    const ChosenSensor sensor = sensor_of(chosen);
    const SensorParams& params = sensor.description.params;
    FlatField field(params, whole_in(seed, "seed"));
    Series series{.bits = params.bit_depth,
                  .cols = FlatField::kShape.cols,
                  .rows = FlatField::kShape.rows,
                  .groups = {}};
    std::vector<double> photons_of_image;
    for (const auto& [photons, images] : flat_field_exposures(params)) {
        const std::vector<std::string> files(static_cast<std::size_t>(images), "image");
        series.groups.push_back({.exposure_ns = params.slot_us * 1000,
                                 .photons = photons,
                                 .dark = photons == 0,
                                 .files = files});
        photons_of_image.insert(photons_of_image.end(), files.size(), photons);
    }
    auto photons = photons_of_image.begin();
    const auto take = [&](const fs::path& /*file*/) {
        return SeriesImage{series.rows, series.cols, field.capture(*photons++)};
    };
    const std::string where = fmt::format("sensor \"{}\"", sensor.choice.sensor);
    return evaluation_dict(evaluate_series(series, where, {}, tell, take),
                           configured_figures(params));
}

py::dict characterize_files(const fs::path& descriptor, const py::object& tell) {
    const auto bytes = reading(descriptor, [&] { return read_file(descriptor); });
    const Series series = emva1288::parse_series(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, descriptor.string());
    const auto take = [](const fs::path& file) {
        DnImage image = read_dn_image(file);
        return SeriesImage{image.shape.rows, image.shape.cols, std::move(image.dn)};
    };
    return evaluation_dict(
        evaluate_series(series, descriptor.string(), descriptor.parent_path(), tell, take), {});
}

/// The series of these stacks, whose "files" are named "images[0][1]".
Series series_of(const std::vector<ImageStack>& stacks, int bits) {
    if (bits < 1 || bits > 16) throw InputError("bits", fmt::format("{} is outside 1..16", bits));
    Series series{.bits = bits, .cols = 0, .rows = 0, .groups = {}};
    for (const ImageStack& stack : stacks) {
        const std::string name = fmt::format("images[{}]", series.groups.size());
        if (stack.dn.ndim() != 3 || stack.dn.shape(0) < 2 || stack.dn.size() == 0)
            throw InputError(name, "is not an array (image, row, col) of two images or more");
        series.rows = static_cast<int>(stack.dn.shape(1));
        series.cols = static_cast<int>(stack.dn.shape(2));
        auto& group = series.groups.emplace_back();
        group.exposure_ns = stack.exposure_ns;
        group.photons = stack.photons;
        group.dark = stack.photons == 0;
        for (py::ssize_t i = 0; i < stack.dn.shape(0); ++i)
            group.files.push_back(fmt::format("{}[{}]", name, i));
    }
    return series;
}

py::dict characterize_arrays(const std::vector<std::tuple<double, double, py::array>>& images,
                             int bits, const py::object& tell) {
    std::vector<ImageStack> stacks;
    for (const auto& [exposure_ns, photons, array] : images) {
        const char kind = array.dtype().kind();
        if (kind != 'u' || array.itemsize() > 2)
            throw InputError(fmt::format("images[{}]", stacks.size()),
                             "is neither uint8 nor uint16");
        stacks.push_back({exposure_ns, photons, array});
    }
    const Series series = series_of(stacks, bits);
    std::size_t stack = 0;
    py::ssize_t image = 0;
    const auto take = [&](const fs::path& /*file*/) {
        const auto& dn = stacks[stack].dn;
        const std::uint16_t* const begin = dn.data(image);
        SeriesImage taken{static_cast<int>(dn.shape(1)),
                          static_cast<int>(dn.shape(2)),
                          {begin, begin + dn.shape(1) * dn.shape(2)}};
        if (++image == dn.shape(0)) {
            ++stack;
            image = 0;
        }
        return taken;
    };
    return evaluation_dict(evaluate_series(series, "images", {}, tell, take), {});
}

}  // namespace

void bind_characterize(py::module_& module) {
    module.def("characterize", &characterize);
    module.def("characterize_files", &characterize_files);
    module.def("characterize_arrays", &characterize_arrays);
}

}  // namespace stipple::python
