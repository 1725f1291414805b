#include "python/stream.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/schedule.h"
#include "stream/stream_figures.h"

namespace stipple::python {
namespace {

py::dict counts_of(const StreamFile& stream) {
    const StreamReport report = stream.read_through();
    py::list damage;
    for (const StreamDamage& place : report.damage)
        damage.append(dict_of([&](const auto& add) { visit_damage_figures(place, add); }));
    return dict_of([&](const auto& add) {
        add("version", report.version);
        visit_report_figures(report, add);
        add("damage", damage);
        add("unlisted_damage", report.unlisted_damage);
    });
}

const ExposureSchedule& only_schedule(const StreamFile& stream) {
    if (stream.header().may_switch)
        throw InputError(stream.name(),
                         "may change its schedule; samples tells the exposure of each sample");
    return stream.header().schedule;
}

constexpr char kSamplesText[] =
    R"(The samples of a slot, of a range of slots, or of all slots, in the order of the readout: a
structured array with the fields slot (read at its end), row, col, plane, exposure_slots (slots since
the exposure began), light_slots (of these, with the shutter open), saturated (a lower bound only),
open_slots (bit i: the shutter was open in slot + 1 - exposure_slots + i) and dn. Slots of an exposure
are 0 where they are unknown, after a switch that is missing. saturated is by the calibration in the
header.

slots: a slot, range(first, end), or None for all. Slot by slot is fast; going back begins at the first.

Raises IndexError for slots that there are not, ValueError if the samples need too much memory.)";

/// `slots` is None or a range of step 1.
py::array samples_in(StreamFile& stream, const py::object& slots) {
    if (slots.is_none()) return stream.samples_between(0, stream.slots());
    const StreamSlots range = slots_in(slots, "slots");
    return stream.samples_between(range.first, range.end);
}

std::string repr_of(StreamFile& stream) {
    const std::string name = stream.is_temporary() ? "(temporary)" : stream.path().string();
    if (!stream.is_open()) return fmt::format("<stipple.Stream {}: closed>", name);
    const FrameShape shape = stream.header().shape;
    return fmt::format("<stipple.Stream {}: {} slot{} of {} x {} x {}>", name, stream.slots(),
                       stream.slots() == 1 ? "" : "s", shape.cols, shape.rows, shape.planes);
}

/// What lets it stand where Python wants a context, a path, an iterable, or what pickle takes.
void bind_protocols(py::class_<StreamFile>& stream) {
    stream.def("__repr__", &repr_of)
        .def("close", &StreamFile::close,
             "Closes the file, as the end of a with block does. A temporary one is gone then.")
        .def("__enter__", [](const py::object& self) { return self; })
        .def("__exit__", [](StreamFile& self, const py::args& /*exception*/) { self.close(); })
        .def(
            "__fspath__",
            [](const StreamFile& self) { return py::cast(self.saved_path()).attr("__fspath__")(); })
        .def("__reduce__",
             [](const StreamFile& self) {
                 const auto call = py::module_::import("operator").attr("methodcaller");
                 return py::make_tuple(call("open", self.saved_path()),
                                       py::make_tuple(py::type::of<StreamFile>()));
             })
        .def("__len__", &StreamFile::slots)
        .def("__iter__", [](const py::object& self) {
            const py::module_ python = py::module_::import("builtins");
            return python.attr("map")(self.attr("samples"), python.attr("range")(py::len(self)));
        });
}

}  // namespace

void bind_sample_rows();

py::dict header_dict(const StreamHeader& header) {
    return dict_of([&](const auto& add) {
        visit_header_figures(header, add);
        add("calibration", dict_of([&](const auto& add_to) {
                visit_calibration_figures(header.calibration, add_to);
            }));
        add("schedule",
            dict_of([&](const auto& add_to) { visit_schedule_figures(header, add_to); }));
        add("provenance", header.provenance);
    });
}

void bind_stream(py::module_& module) {
    bind_sample_rows();
    py::class_<StreamFile> stream(module, "Stream",
                                  "A sample stream: what leaves the chip, in a file.");
    stream
        .def_static(
            "open",
            [](const py::object& path) {
                return std::make_unique<StreamFile>(path_in(path, "path"));
            },
            py::arg("path"),
            "Opens a .stipple file. Raises OSError if it cannot be read, ValueError if it is "
            "no\nstream.")
        .def_property_readonly(
            "path",
            [](const StreamFile& self) -> py::object {
                if (self.is_temporary()) return py::none();
                return py::cast(self.path());
            },
            "Its file, or None of a temporary one.")
        .def_property_readonly(
            "shape",
            [](const StreamFile& self) {
                const FrameShape shape = self.header().shape;
                return std::tuple(shape.rows, shape.cols, shape.planes);
            },
            "(rows, columns, planes) of the array of pixels.")
        .def_property_readonly(
            "header", [](const StreamFile& self) { return header_dict(self.header()); },
            "What it says of itself: the keys of \"stipple info\" (docs/outputs.md).")
        .def_property_readonly(
            "figures", &StreamFile::figures,
            "What \"stipple emulate\" says of it (docs/outputs.md), or None of a "
            "stream that was opened.")
        .def(
            "exposures", [](const StreamFile& self) { return exposures_of(only_schedule(self)); },
            "The exposures of its schedule, as Schedule.exposures(). Raises ValueError if it may "
            "change.")
        .def(
            "weights", [](const StreamFile& self) { return weights_of(only_schedule(self)); },
            "The weights of its schedule, as Schedule.weights().")
        .def("slots", &StreamFile::slots, "Number of slots. Reads an interrupted stream through.")
        .def("samples", &StreamFile::samples, py::arg("slot"))
        .def("samples", &samples_in, py::arg("slots") = py::none(), kSamplesText)
        .def("counts", &counts_of,
             "Reads the stream through: what it holds and what is damaged, as \"stipple info\".")
        .def("save", &StreamFile::save, py::arg("path"), py::arg("force") = false,
             py::call_guard<py::gil_scoped_release>(),
             "Copies it to a file. force: replace one that is there. Raises OSError.");
    bind_protocols(stream);
}

}  // namespace stipple::python
