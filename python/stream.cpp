#include "python/stream.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "core/colour_filter.h"
#include "python/bindings.h"
#include "python/schedule.h"
#include "readout/provenance.h"

namespace stipple::python {
namespace {

using namespace pybind11::literals;

py::dict calibration_dict(const Calibration& calibration) {
    py::list responsivity, conversion_gain;
    for (const CalibrationPixel& pixel : calibration.tile.pixels) {
        responsivity.append(pixel.responsivity);
        conversion_gain.append(pixel.conversion_gain);
    }
    return py::dict("bit_depth"_a = calibration.bit_depth,
                    "rounding"_a = calibration.rounding == Rounding::kFloor ? "floor" : "nearest",
                    "black_level_dn"_a = calibration.black_level_dn,
                    "gain_e_per_dn"_a = calibration.gain_e_per_dn,
                    "read_noise_e"_a = calibration.read_noise_e,
                    "full_well_e"_a = calibration.full_well_e,
                    "electrons_per_unit"_a = calibration.electrons_per_unit,
                    "dark_e_per_slot"_a = calibration.dark_e_per_slot,
                    "tile_rows"_a = calibration.tile.rows, "tile_cols"_a = calibration.tile.cols,
                    "responsivity"_a = responsivity, "conversion_gain"_a = conversion_gain);
}

py::dict schedule_dict(const StreamHeader& header) {
    const ExposureSchedule& schedule = header.schedule;
    py::dict dict("name"_a = header.schedule_name, "tile_rows"_a = schedule.tile_rows(),
                  "tile_cols"_a = schedule.tile_cols(), "period_slots"_a = schedule.period_slots(),
                  "samples_per_pixel_slot"_a = schedule.samples_per_pixel_slot(),
                  "light_throughput"_a = schedule.light_throughput(),
                  "gapless"_a = schedule.gapless(), "interleaved"_a = schedule.interleaved());
    if (header.schedule_source.kind == ScheduleSource::Kind::kRandom) {
        dict["exposure_slots"] = header.schedule_source.exposure_slots;
        dict["seed"] = header.schedule_source.seed;
    }
    return dict;
}

py::dict counts_of(const StreamFile& stream) {
    const StreamReport report = stream.read_through();
    py::list damage;
    for (const StreamDamage& where : report.damage)
        damage.append(
            py::dict("offset"_a = where.offset, "bytes"_a = where.bytes, "cause"_a = where.cause));
    return py::dict("version"_a = report.version, "slots"_a = report.slots,
                    "packets"_a = report.packets, "samples"_a = report.samples,
                    "payload_bits"_a = report.payload_bits,
                    "missing_slots"_a = report.missing_slots, "complete"_a = report.complete,
                    "tail_bytes"_a = report.tail_bytes, "damage"_a = damage,
                    "unlisted_damage"_a = report.unlisted_damage);
}

}  // namespace

void bind_sample_rows();

py::dict header_dict(const StreamHeader& header) {
    return py::dict("rows"_a = header.shape.rows, "cols"_a = header.shape.cols,
                    "planes"_a = header.shape.planes, "cfa"_a = std::string(name_of(header.cfa)),
                    "slot_us"_a = header.slot_us,
                    "calibration"_a = calibration_dict(header.calibration),
                    "schedule"_a = schedule_dict(header), "provenance"_a = header.provenance);
}

std::string damage_text(const StreamReport& report) {
    if (report.damage.empty() && report.missing_slots == 0 && report.tail_bytes == 0) return {};
    if (report.damage.empty() && report.missing_slots == 0)
        return fmt::format(
            "the stream is cut off: {} slots are whole, then it ends within a packet, of which "
            "there "
            "are {} bytes",
            report.slots, report.tail_bytes);
    std::string text = fmt::format("the stream is damaged; {} of {} slots are incomplete",
                                   report.missing_slots, report.slots);
    constexpr std::size_t kMaxPlaces = 10;
    const std::size_t listed = std::min(report.damage.size(), kMaxPlaces);
    for (const StreamDamage& where : std::span(report.damage).first(listed))
        text += fmt::format("\n  byte {}: {}, {} bytes skipped", where.offset, where.cause,
                            where.bytes);
    const std::uint64_t places = report.damage.size() + report.unlisted_damage;
    if (places > listed) text += fmt::format("\n  and {} more", places - listed);
    if (report.tail_bytes > 0)
        text += fmt::format("\n  the file ends within a packet, its last {} bytes are unused",
                            report.tail_bytes);
    return text;
}

void bind_stream(py::module_& module) {
    bind_sample_rows();
    py::class_<StreamFile>(module, "Stream", "A sample stream: what leaves the chip, in a file.")
        .def_static(
            "open",
            [](const std::filesystem::path& path) { return std::make_unique<StreamFile>(path); },
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
            "What it says of itself: the keys of \"stipple info\" (docs/cli.md).")
        .def_property_readonly("figures", &StreamFile::figures,
                               "What \"stipple emulate\" says of it (docs/cli.md), or None of a "
                               "stream that was opened.")
        .def(
            "exposures",
            [](const StreamFile& self) { return exposures_of(self.header().schedule); },
            "The exposures of its schedule, as Schedule.exposures().")
        .def("slots", &StreamFile::slots, "Number of slots. Reads an interrupted stream through.")
        .def("samples", &StreamFile::samples, py::arg("slot"),
             R"(The samples of a slot: an array with the fields row, col, plane, exposure_slots
(slots since the exposure began), light_slots (of these, with the shutter open) and dn, in the order
of the readout. Fast from slot to slot; going back begins at the first. Raises IndexError.)")
        .def("counts", &counts_of,
             "Reads the stream through: what it holds and what is damaged, as \"stipple info\".")
        .def("save", &StreamFile::save, py::arg("path"), py::arg("force") = false,
             py::call_guard<py::gil_scoped_release>(),
             "Copies it to a file. force: replace one that is there. Raises OSError.")
        .def("__repr__", [](StreamFile& self) {
            const FrameShape shape = self.header().shape;
            return fmt::format("<stipple.Stream {}: {} slots of {} x {} x {}>",
                               self.is_temporary() ? "(temporary)" : self.path().string(),
                               self.slots(), shape.rows, shape.cols, shape.planes);
        });
}

}  // namespace stipple::python
