#include "python/schedule.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "core/light.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "io/output_file.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/sensor.h"
#include "readout/schedule_feasibility.h"
#include "readout/schedules/code_schedule.h"
#include "stream/plain_text.h"
#include "stream/stream_header.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

using Tile = std::pair<int, int>;  ///< rows, columns

/// A row of the array of exposures.
struct ExposureRow {
    std::uint16_t row, col;
    std::uint32_t first_slot;
    std::uint64_t open_slots;
};

ChosenSchedule choose_schedule(const py::object& name, const py::dict& settings,
                               const py::object& chosen_size, const py::object& seed,
                               const py::object& sensor) {
    const auto size = size_in(chosen_size, "size");
    ColumnAddressing addressing;
    py::object chosen_sensor = py::none();
    if (!sensor.is_none()) {
        ChosenSensor chosen = sensor_of(sensor);
        if (const auto& timing = chosen.description.timing) addressing = timing->addressing;
        chosen_sensor = py::cast(std::move(chosen));
    }
    ChosenSchedule schedule{.choice = SensorChoice{.schedule = path_in(name, "schedule").string(),
                                                   .schedule_settings = settings_of(settings),
                                                   .seed = whole_in(seed, "seed")},
                            .shape = checked_shape(size.first, size.second, 1, "size"),
                            .made = NamedSchedule{"", {}, ExposureSchedule(1, 1, 1, {0, 0}, {})},
                            .sensor = std::move(chosen_sensor)};
    const auto make = [&] { return set_up_schedule(schedule.choice, schedule.shape, addressing); };
    schedule.made =
        is_path(schedule.choice.schedule) ? reading(schedule.choice.schedule, make) : make();
    return schedule;
}

void save(const ChosenSchedule& schedule, const fs::path& file, bool force) {
    check_name(file, kScheduleName);
    creating(file, [&] {
        PendingOutput pending(file, force);
        const std::string text = code_text(schedule.made.schedule, schedule.made.name);
        OutputFile output(pending.partial(), file.string());
        output.write(std::as_bytes(std::span(text)));
        output.close();
        pending.commit();
    });
}

/// What makes it again in another process: arguments of the constructor, or of a file, which may
/// not be there, the text of a file of its exposures.
py::object content_of(const ChosenSchedule& schedule) {
    if (is_path(schedule.choice.schedule))
        return py::str(code_text(schedule.made.schedule, schedule.made.name));
    return py::make_tuple(
        schedule.choice.schedule, settings_dict(schedule.choice.schedule_settings),
        Tile(schedule.shape.rows, schedule.shape.cols), schedule.choice.seed, schedule.sensor);
}

/// Why the sensor cannot do it, or None.
std::optional<std::string> problem_of(const ChosenSchedule& schedule, const py::object& sensor) {
    return schedule_problem(
        set_up_sensor(sensor_of(sensor).description, schedule.choice, schedule.shape));
}

/// Gives a schedule the weights of an array as `weights_of` makes.
void set_weights(ExposureSchedule& schedule,
                 const py::array_t<float, py::array::c_style | py::array::forcecast>& weights) {
    const std::vector<py::ssize_t> shape{schedule.period_slots(), schedule.tile_rows(),
                                         schedule.tile_cols()};
    if (!std::equal(shape.begin(), shape.end(), weights.shape(), weights.shape() + weights.ndim()))
        throw InputError("weights",
                         fmt::format("are not an array (slots, rows, columns) of {} x {} x "
                                     "{}, the period and the tile",
                                     shape[0], shape[1], shape[2]));
    schedule.set_weights({weights.data(), weights.data() + weights.size()});
}

/// The text of a schedule file of these exposures: arrays as `exposures_of` and, unless it is None,
/// `weights_of` make them.
std::string text_of(const py::array_t<ExposureRow>& rows, Tile tile, int period_slots,
                    const std::string& name, const py::object& weights) {
    if (tile.first < 1 || tile.second < 1 || rows.ndim() != 1 || rows.size() == 0)
        throw InputError("exposures",
                         "give a list of at least one, and a tile of at least 1 x 1 pixels");
    if (name.size() > kMaxNameBytes || !is_plain_text(name, false))
        throw InputError(
            "name", fmt::format("give at most {} bytes without control characters", kMaxNameBytes));
    const auto pixels =
        static_cast<std::size_t>(tile.first) * static_cast<std::size_t>(tile.second);
    if (pixels > kMaxCodeSlots) throw InputError("tile", "is larger than a schedule may have");
    std::vector<std::vector<Exposure>> by_pixel(pixels);
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
        const ExposureRow& row = rows.at(i);
        if (row.row >= tile.first || row.col >= tile.second)
            throw InputError("exposures",
                             fmt::format("row {}, column {} is outside the tile of {} x {}",
                                         row.row, row.col, tile.first, tile.second));
        by_pixel[static_cast<std::size_t>(row.row) * static_cast<std::size_t>(tile.second) +
                 row.col]
            .push_back({row.first_slot, row.open_slots});
    }
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (const auto& of_pixel : by_pixel) {
        exposures.insert(exposures.end(), of_pixel.begin(), of_pixel.end());
        first.push_back(static_cast<std::uint32_t>(exposures.size()));
    }
    ExposureSchedule schedule(tile.first, tile.second, period_slots, std::move(first),
                              std::move(exposures));
    if (!weights.is_none()) set_weights(schedule, weights);
    return code_text(schedule, name);
}

void bind_figures(py::class_<ChosenSchedule>& schedule) {
    const auto add = [&](const char* name, auto figure, const char* text) {
        schedule.def_property_readonly(
            name, [figure](const ChosenSchedule& self) { return figure(self.made.schedule); },
            text);
    };
    schedule
        .def_property_readonly(
            "name", [](const ChosenSchedule& self) { return self.made.name; },
            "Its name in the header of a stream.")
        .def_property_readonly(
            "size",
            [](const ChosenSchedule& self) { return Tile(self.shape.rows, self.shape.cols); },
            "(rows, columns) of the array that it was made for.");
    using Plan = ExposureSchedule;
    add(
        "tile", [](const Plan& plan) { return Tile(plan.tile_rows(), plan.tile_cols()); },
        "(rows, columns) of the tile that repeats over the array.");
    add("period_slots", std::mem_fn(&Plan::period_slots), "Slots after which all repeats.");
    add("charge_stores", std::mem_fn(&Plan::charge_stores),
        "Exposures of a pixel that are under way at once, at most.");
    add("samples_per_pixel_slot", std::mem_fn(&Plan::samples_per_pixel_slot),
        "Its inverse is the compression ratio.");
    add("light_throughput", std::mem_fn(&Plan::light_throughput),
        "Share of all pixels and slots that collects light; with weights their mean.");
    add("weighted", std::mem_fn(&Plan::weighted), "Whether some weight of an open slot is not 1.");
}

}  // namespace

py::array exposures_of(const ExposureSchedule& schedule) {
    std::vector<ExposureRow> rows;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col))
                rows.push_back({static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(col),
                                exposure.first_slot, exposure.open_slots});
    return py::array_t<ExposureRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

py::array weights_of(const ExposureSchedule& schedule) {
    const int period = schedule.period_slots();
    const int rows = schedule.tile_rows();
    const int cols = schedule.tile_cols();
    check_memory(sizeof(float) * index(period) * index(rows) * index(cols), "weights", "the array");
    py::array_t<float> array({period, rows, cols});
    std::fill_n(array.mutable_data(), array.size(), 0.0F);
    auto weights = array.mutable_unchecked<3>();
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            for (const Exposure& exposure : schedule.exposures(row, col))
                for (int i = 0; i < exposure.span_slots(); ++i) {
                    if ((exposure.open_slots >> static_cast<unsigned>(i) & 1U) == 0) continue;
                    const int slot = (static_cast<int>(exposure.first_slot) + i) % period;
                    weights(slot, row, col) =
                        schedule.weighted() ? schedule.weight(slot, row, col) : 1.0F;
                }
    return array;
}

ChosenSensor with_seed_of(const py::object& schedule, ChosenSensor sensor) {
    if (py::isinstance<ChosenSchedule>(schedule))
        sensor.choice.seed = schedule.cast<const ChosenSchedule&>().choice.seed;
    return sensor;
}

SensorSetup set_up(const ChosenSensor& sensor, const py::object& schedule, FrameShape footage,
                   ColourFilter mosaic) {
    SensorChoice choice = sensor.choice;
    const bool is_made = py::isinstance<ChosenSchedule>(schedule);
    if (is_made) {
        const auto& made = schedule.cast<const ChosenSchedule&>();
        choice.schedule = made.choice.schedule;
        choice.schedule_settings = made.choice.schedule_settings;
    } else {
        choice.schedule = path_in(schedule, "schedule").string();
    }
    SensorSetup setup = set_up_sensor(sensor.description, choice, footage, mosaic);
    if (is_made) {
        const auto& made = schedule.cast<const ChosenSchedule&>();
        if (made.made.schedule != setup.schedule.schedule)
            throw InputError(
                "schedule",
                fmt::format(
                    "was made for {} x {} pixels with seed {}; for {} x {} with seed {} and this "
                    "sensor it is another one: make it for these, or give its name",
                    made.shape.rows, made.shape.cols, made.choice.seed, setup.shape.rows,
                    setup.shape.cols, setup.seed));
    }
    return setup;
}

void bind_schedule(py::module_& module) {
    PYBIND11_NUMPY_DTYPE(ExposureRow, row, col, first_slot, open_slots);
    py::class_<ChosenSchedule> schedule(module, "Schedule",
                                        R"(Which pixel exposes when, as made for an array of pixels.

schedule: one of Schedule.names(), or the path of a .toml, .mem or .hex file.
settings: keys of the file to change, {"tile_rows": 8}.
size: (rows, columns) of the array.
seed: of random exposures.
sensor: whose columns schedules of kind "hardware_tiled" suit.

Raises ValueError for a key or value that the file may not have, OSError for a missing file.)");
    schedule
        .def(py::init(&choose_schedule), py::arg("schedule") = "random",
             py::arg("settings") = py::dict(), py::arg("size") = Tile(480, 640),
             py::arg("seed") = 1, py::arg("sensor") = py::none())
        .def_static(
            "names", [] { return config_names(ConfigKind::kSchedules); },
            "The schedules of config/schedules.")
        .def(
            "exposures",
            [](const ChosenSchedule& self) { return exposures_of(self.made.schedule); },
            R"(All exposures of the tile: an array with the fields row, col (of the tile),
first_slot (0 .. period_slots - 1) and open_slots, whose bit i says that the shutter is open in slot
first_slot + i. An exposure is read at the end of its last open slot.)")
        .def(
            "weights", [](const ChosenSchedule& self) { return weights_of(self.made.schedule); },
            R"(An array (slot of the period, row, col) of the tile, with the share of its light that
a pixel collects in a slot, 0 where the shutter is closed and 1 where it is open without a grey
mask. A sample is the sum of weight x light over the open slots of its exposure.)")
        .def("check", &problem_of, py::arg("sensor") = "paper",
             "Why the sensor cannot do it: too few charge stores or too little time; or None.")
        .def("save", &save, py::arg("path"), py::arg("force") = false,
             "Writes it as a file of kind \"code\", which the program reads too.")
        .def("_content", &content_of)
        .def("__repr__", [](const ChosenSchedule& self) {
            const ExposureSchedule& plan = self.made.schedule;
            return fmt::format("<stipple.Schedule {}: tile {} x {}, period {}>", self.made.name,
                               plan.tile_rows(), plan.tile_cols(),
                               counted(plan.period_slots(), "slot"));
        });
    bind_figures(schedule);
    module.def("schedule_text", &text_of, py::arg("exposures"), py::arg("tile"),
               py::arg("period_slots"), py::arg("name"), py::arg("weights") = py::none());
}

}  // namespace stipple::python
