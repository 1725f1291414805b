#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/disk_sync.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/footage.h"
#include "python/stream.h"
#include "python/stream_samples.h"
#include "readout/measured_stream.h"
#include "session/measurement_export.h"
#include "session/stream_calibration.h"
#include "stream/stream_figures.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// What of a stream is exported, and how.
struct ExportTask {
    ExportOptions options;
    std::optional<fs::path> calibration;  ///< as calibration_choice
};

ExportTask export_task(const std::string& masks, const py::object& slots,
                       const std::optional<fs::path>& calibration) {
    ExportTask task{.options = {}, .calibration = calibration};
    task.options.masks = value_in(kExportMasks, masks, "masks");
    if (slots.is_none()) return task;
    const StreamSlots range = slots_in(slots, "slots");
    if (range.end > std::numeric_limits<int>::max())
        throw InputError("slots", fmt::format("{} is too far", range.end));
    task.options.slots = {static_cast<int>(range.first), static_cast<int>(range.end)};
    return task;
}

/// An array that owns the values.
template <typename Value>
py::array owned(const std::vector<std::size_t>& shape, std::vector<Value> values) {
    auto kept = std::make_unique<std::vector<Value>>(std::move(values));
    const py::capsule owner(kept.get(),
                            [](void* memory) { delete static_cast<std::vector<Value>*>(memory); });
    Value* const data = kept.release()->data();
    return py::array_t<Value>(shape, data, owner);
}

py::dict dict_of_arrays(std::vector<NamedArray> arrays) {
    py::dict dict;
    for (NamedArray& array : arrays)
        std::visit(
            [&](auto& values) { dict[array.name.c_str()] = owned(array.shape, std::move(values)); },
            array.values);
    return dict;
}

MeasurementExport read_export(const StreamFile& stream, const ExportTask& task,
                              const py::object& tell) {
    CalibrationChoice calibration;
    if (task.calibration)
        calibration = calibration_choice(*task.calibration);
    else if (stream.is_temporary())
        calibration.emplace();  // nothing lies beside it
    StreamReader reader = stream.reader();
    const auto add_calibration = [&] { warn(calibrate(reader, calibration)); };
    if (calibration && !calibration->empty())
        reading(*calibration, add_calibration);
    else
        add_calibration();
    CallProgress progress(tell, reader.slots());
    std::optional<MeasurementExport> result;
    {
        const py::gil_scoped_release released;
        result = export_measurements(reader, task.options,
                                     [&](double slots) { return progress.reach(slots); });
    }
    progress.finish();
    if (!undamaged(reader.report()))
        warn(fmt::format("{}: {}", stream.name(), damage_text(reader.report())));
    return std::move(*result);
}

py::dict export_arrays(const StreamFile& stream, const ExportTask& task,
                       const std::optional<fs::path>& output, bool force, const py::object& tell) {
    if (!output) return dict_of_arrays(read_export(stream, task, tell).arrays);
    check_name(*output, kArraysName);
    std::unique_ptr<PendingOutput> pending =
        creating(*output, [&] { return std::make_unique<PendingOutput>(*output, force); });
    MeasurementExport result = read_export(stream, task, tell);
    {
        const py::gil_scoped_release released;
        write_export(result, *pending);
    }
    return dict_of_arrays(std::move(result.arrays));
}

/// The numbers of an import, checked as the options of "stipple import".
MeasuredArrays measured_arrays(const py::dict& numbers, const std::string& cfa) {
    MeasuredArrays arrays;
    arrays.cfa = value_in(kColourFilters, cfa, "cfa");
    constexpr auto kLeast = static_cast<double>(std::numeric_limits<float>::min());
    constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
    const auto take = [&](const char* name, double min, double max) -> std::optional<double> {
        const py::object value = numbers[name];
        if (value.is_none()) return std::nullopt;
        const auto number = value.cast<double>();
        if (number >= min && number <= max) return number;
        throw InputError(name, fmt::format("{:g} is outside {:.3g}..{:.3g}", number, min, max));
    };
    arrays.light = take("light", kLeast, kMost).value_or(0);
    arrays.white = take("white", kLeast, kMost).value_or(0);
    arrays.saturation = take("saturation", kLeast, kMost);
    arrays.electrons = take("electrons", 1e-3, 1e9);
    arrays.read_noise_e = take("read_noise", 0, 1e9).value_or(0);
    arrays.slot_us = take("slot_us", 1e-6, 1e12).value();
    return arrays;
}

/// An array (layer, row, col), or a single layer where that is allowed.
NpyVolume volume_of(const Doubles& array, const char* name, NpyImages images) {
    const bool image = images == NpyImages::kOneLayer && array.ndim() == 2;
    const bool sides = array.size() > 0 && (array.ndim() == 3 || image);
    constexpr py::ssize_t kMaxValues = py::ssize_t{1} << 26U;
    if (!sides || array.size() > kMaxValues)
        throw InputError(name,
                         fmt::format("has the shape ({}), not {}(layers, rows, columns) of "
                                     "at most 2^26 values",
                                     fmt::join(array.shape(), array.shape() + array.ndim(), ", "),
                                     images == NpyImages::kOneLayer ? "(rows, columns) or " : ""));
    const py::ssize_t* const shape = array.shape() + (image ? 0 : 1);
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        if (array.shape(i) > kMaxFrameSide)
            throw InputError(name, fmt::format("has a side above {}", kMaxFrameSide));
    return {.layers = image ? 1 : static_cast<int>(array.shape(0)),
            .rows = static_cast<int>(shape[0]),
            .cols = static_cast<int>(shape[1]),
            .values = std::vector<double>(array.data(), array.data() + array.size())};
}

MeasuredArrays of_arrays(MeasuredArrays arrays, const Doubles& measurements, const Doubles& masks,
                         int slots) {
    arrays.measurement_file = "measurements";
    arrays.mask_file = "masks";
    arrays.measurements = volume_of(measurements, "measurements", NpyImages::kOneLayer);
    arrays.masks = volume_of(masks, "masks", NpyImages::kRefused);
    keep_masks(arrays.masks, slots, "masks");
    return arrays;
}

MeasuredArrays of_files(MeasuredArrays arrays, const fs::path& measurements,
                        const std::optional<fs::path>& masks,
                        const std::pair<std::string, std::string>& variables, int slots) {
    const MeasuredFiles files{.measurements = measurements.string(),
                              .masks = masks.value_or("").string(),
                              .variable = variables.first,
                              .mask_variable = variables.second,
                              .slots = slots};
    reading(measurements, [&] {
        if (masks) return reading(*masks, [&] { read_measured_files(files, arrays); });
        read_measured_files(files, arrays);
    });
    return arrays;
}

std::unique_ptr<StreamFile> import(const MeasuredArrays& arrays,
                                   const std::optional<fs::path>& output, bool force) {
    if (output) check_name(*output, kStreamName);
    std::unique_ptr<TemporaryFile> temporary;
    std::optional<NoSync> no_sync;
    if (!output) {
        no_sync.emplace();
        temporary = std::make_unique<TemporaryFile>();
    }
    const fs::path file = output ? *output : temporary->path();
    const ImportedStream stream = creating(file, [&] {
        const py::gil_scoped_release released;
        return import_measurements(arrays, file, force);
    });
    const py::dict figures = dict_of([&](const auto& add) { visit_import_figures(stream, add); });
    warn(unread_text(stream, arrays.mask_file));
    if (output) return std::make_unique<StreamFile>(*output, figures);
    temporary->unname();
    return std::make_unique<StreamFile>(std::move(temporary), figures);
}

}  // namespace

void bind_measurements(py::module_& module) {
    py::class_<ExportTask>(module, "ExportTask").def(py::init(&export_task));
    module.def("export_arrays", &export_arrays);
    py::class_<MeasuredArrays>(module, "MeasuredArrays")
        .def(py::init(&measured_arrays))
        .def("of_arrays", &of_arrays)
        .def("of_files", &of_files);
    module.def("import_measurements", &import);
}

}  // namespace stipple::python
