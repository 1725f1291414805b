#pragma once

#include <pybind11/pybind11.h>

/// The Python module: each function adds the classes and functions of one subject.
namespace stipple::python {

namespace py = pybind11;

void bind_errors();
void bind_limits(py::module_& module);
void bind_footage(py::module_& module);
void bind_sensor(py::module_& module);
void bind_schedule(py::module_& module);
void bind_stream(py::module_& module);
void bind_emulate(py::module_& module);
void bind_chip(py::module_& module);
void bind_decode(py::module_& module);
void bind_denoiser(py::module_& module);
void bind_forward_model(py::module_& module);
void bind_compare(py::module_& module);
void bind_measurements(py::module_& module);
void bind_dictionary(py::module_& module);
void bind_explore(py::module_& module);
void bind_timing(py::module_& module);
void bind_recording(py::module_& module);
void bind_calibrate(py::module_& module);
void bind_characterize(py::module_& module);
void bind_camera(py::module_& module);
void bind_camera_frames(py::module_& module);
void bind_camera_search(py::module_& module);
void bind_record(py::module_& module);
void bind_report(py::module_& module);
void bind_rig(py::module_& module);
void bind_synth(py::module_& module);
void bind_live_preview(py::module_& module);
void bind_live(py::module_& module);
void bind_training(py::module_& module);
void bind_view(py::module_& module);

}  // namespace stipple::python
