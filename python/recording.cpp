#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/frame_record.h"
#include "capture/frame_unpack.h"
#include "capture/recording/recording_reader.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/footage.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

constexpr std::array kStatusNames{"complete", "missing_packets", "size_mismatch", "device_error"};

/// A recording, which can be gone through again and again.
struct RecordingFile {
    fs::path path;
    SessionRecord session;
};

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

/// Digital numbers: (row, col), of interleaved colour (row, col, plane).
py::array dn_of(const CapturedFrame& frame) {
    const FrameLayout& layout = frame.record.layout;
    auto samples = std::make_unique<std::vector<std::uint16_t>>();
    unpack_frame(layout, frame.payload, *samples);
    std::vector<py::ssize_t> shape{layout.height, layout.width};
    if (layout.format->planes > 1) shape.push_back(layout.format->planes);
    const py::capsule owner(samples.get(), [](void* memory) {
        delete static_cast<std::vector<std::uint16_t>*>(memory);
    });
    const std::uint16_t* const dn = samples.release()->data();
    return py::array_t<std::uint16_t>(shape, dn, owner);
}

void bind_frame(py::module_& module) {
    py::class_<CapturedFrame> frame(module, "Frame",
                                    "A frame of a recording, as the camera sent it.");
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
                                "Digital numbers, uint16: (row, col), of RGB (row, col, plane).");
}

}  // namespace

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
            [](const fs::path& path) {
                return RecordingFile{path, frames_of(path).reader.session()};
            },
            py::arg("path"),
            "Opens a .strec file. Raises OSError if it cannot be read, ValueError if it is no\n"
            "recording.")
        .def_readonly("path", &RecordingFile::path, "Its file.")
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
