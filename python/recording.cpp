#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <bit>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/frame_light.h"
#include "capture/frame_record.h"
#include "capture/recording/recording_reader.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/recording.h"

namespace stipple::python {
namespace fs = std::filesystem;
using namespace pybind11::literals;
namespace {

constexpr std::array kStatusNames{"complete", "missing_packets", "size_mismatch", "device_error"};

/// One way through the frames of a recording.
struct RecordingFrames {
    fs::path path;
    RecordingReader reader;
};

RecordingFrames frames_of(const fs::path& path) {
    return {path, reading(path, [&] { return RecordingReader(path); })};
}

/// The next frame. At the end Python is warned of what is wrong with the file.
std::unique_ptr<CapturedFrame> next_frame(RecordingFrames& frames) {
    auto frame = std::make_unique<CapturedFrame>();
    bool has_frame = false;
    {
        const py::gil_scoped_release released;
        has_frame = frames.reader.next(*frame);
    }
    if (has_frame) return frame;
    for (const std::string& fault : frames.reader.faults())
        warn(fmt::format("{}: {}", frames.path.string(), fault), 1);
    throw py::stop_iteration();
}

/// The array, which Python must not write to: it may be the frame itself.
py::array read_only(py::array array) {
    array.attr("setflags")("write"_a = false);
    return array;
}

/// Whether the payload holds all samples as words of this machine.
bool holds_words(const CapturedFrame& frame) {
    const FrameLayout& layout = frame.record.layout;
    return std::endian::native == std::endian::little &&
           layout.format->packing == Packing::kBytes && layout.format->significant_bits > 8 &&
           frame.payload.size() >= layout.payload_bytes();
}

/// Digital numbers: (row, col), of interleaved colour (row, col, plane).
py::array dn_of(const py::object& self) {
    const auto& frame = self.cast<const CapturedFrame&>();
    const FrameLayout& layout = frame.record.layout;
    const py::ssize_t planes = layout.format->planes;
    if (holds_words(frame)) {
        std::vector<py::ssize_t> shape{layout.height, layout.width};
        std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(layout.stride_bytes), 2 * planes};
        if (planes > 1) {
            shape.push_back(planes);
            strides.push_back(2);
        }
        return read_only(
            py::array(py::dtype::of<std::uint16_t>(), shape, strides, frame.payload.data(), self));
    }
    auto samples = std::make_unique<std::vector<std::uint16_t>>();
    unpack_frame(layout, frame.payload, *samples);
    std::vector<py::ssize_t> shape{layout.height, layout.width};
    if (layout.format->planes > 1) shape.push_back(layout.format->planes);
    const py::capsule owner(samples.get(), [](void* memory) {
        delete static_cast<std::vector<std::uint16_t>*>(memory);
    });
    const std::uint16_t* const dn = samples.release()->data();
    return read_only(py::array_t<std::uint16_t>(shape, dn, owner));
}

/// The bytes of the frame, without a copy.
py::array payload_of(const py::object& self) {
    const auto& payload = self.cast<const CapturedFrame&>().payload;
    return read_only(
        py::array_t<std::uint8_t>(static_cast<py::ssize_t>(payload.size()), payload.data(), self));
}

void bind_frame(py::module_& module) {
    py::class_<CapturedFrame> frame(module, "Frame",
                                    "A frame as the camera sent it, of a recording or live.");
    const auto add = [&](const char* name, auto FrameRecord::*field, const char* text) {
        frame.def_property_readonly(
            name, [field](const CapturedFrame& self) { return self.record.*field; }, text);
    };
    add("id", &FrameRecord::id, "Counts from the first frame of the session on.");
    add("lost_before", &FrameRecord::lost_before, "Frames missing before this one.");
    add("device_ns", &FrameRecord::device_ns, "Stamp of the device's clock, in ns.");
    add("host_monotonic_ns", &FrameRecord::host_monotonic_ns, "Arrival, CLOCK_MONOTONIC, in ns.");
    add("host_realtime_ns", &FrameRecord::host_realtime_ns, "Arrival, CLOCK_REALTIME, in ns.");
    add("exposure_us", &FrameRecord::exposure_us, "Exposure time in us, or None.");
    add("gain", &FrameRecord::gain, "In the unit of the device, or None.");
    add("black_level_dn", &FrameRecord::black_level_dn, "DN without light, or None.");
    const auto add_of = [&](const char* name, auto value, const char* text) {
        frame.def_property_readonly(
            name, [value](const CapturedFrame& self) { return value(self.record); }, text);
    };
    add_of(
        "cause",
        [](const FrameRecord& record) {
            return std::string(kGapCauseNames.at(static_cast<std::size_t>(record.cause)));
        },
        "Why frames are missing before it: \"none\", \"device\", \"transport\" ...");
    add_of(
        "status",
        [](const FrameRecord& record) {
            return std::string(kStatusNames.at(static_cast<std::size_t>(record.status)));
        },
        "\"complete\", \"missing_packets\", \"size_mismatch\" or \"device_error\".");
    add_of(
        "format", [](const FrameRecord& record) { return std::string(record.layout.format->name); },
        "Pixel format, as GenICam PFNC names it.");
    add_of(
        "significant_bits",
        [](const FrameRecord& record) { return record.layout.format->significant_bits; },
        "Bits of a DN.");
    add_of(
        "cfa",
        [](const FrameRecord& record) {
            return std::string(name_of(record.layout.format->filter));
        },
        "Colour filter array: \"none\", \"rggb\" ...");
    frame.def_property_readonly("dn", &dn_of,
                                "Digital numbers, uint16, read-only: (row, col), of RGB (row, col, "
                                "plane). Formats of 16-bit\n"
                                "words (Mono10, Mono16 ...) are not copied.");
    frame.def_property_readonly("payload", &payload_of,
                                "Bytes of the frame in its wire format, uint8, read-only, not "
                                "copied. Missing bytes are 0.");
}

}  // namespace

RecordingFile open_recording(const fs::path& path, py::object figures) {
    return {path, frames_of(path).reader.session(), std::move(figures)};
}

void bind_recording(py::module_& module) {
    bind_frame(module);
    py::class_<RecordingFrames>(module, "RecordingFrames")
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &next_frame);
    py::class_<RecordingFile>(module, "Recording",
                              R"(Frames of a camera, as "stipple capture record" keeps them.

Iterating reads frame by frame; damage costs its own frames and is a UserWarning at the end. It is
footage, too: stipple.emulate(recording).)")
        .def_static(
            "open",
            [](const py::object& path) {
                return open_recording(path_in(path, "path"), py::none());
            },
            py::arg("path"),
            "Opens a .strec file. Raises OSError if it cannot be read, ValueError if it is not a\n"
            "recording.")
        .def_readonly("path", &RecordingFile::path, "Its file.")
        .def_readonly(
            "figures", &RecordingFile::figures,
            "The figures of a recording that was just made, as the command prints; else None.")
        .def("__fspath__", [](const RecordingFile& self) { return self.path.string(); })
        .def_property_readonly(
            "camera",
            [](const RecordingFile& self) {
                const CameraDescription& camera = self.session.camera;
                return std::map<std::string, std::string>{{"transport", camera.transport},
                                                          {"vendor", camera.vendor},
                                                          {"model", camera.model},
                                                          {"serial", camera.serial}};
            },
            "Which camera: transport, vendor, model, serial.")
        .def_property_readonly(
            "features", [](const RecordingFile& self) { return self.session.camera.features; },
            "What the camera was set to: the text of each feature that can be read.")
        .def("__iter__", [](const RecordingFile& self) {
            return std::make_unique<RecordingFrames>(frames_of(self.path));
        });
}

}  // namespace stipple::python
