#include "core/version.h"
#include "python/bindings.h"

namespace stipple::python {
namespace {

/// Instead of memory for an object that `__new__` made and `__init__` did not.
void* refuse_uninitialised(std::size_t /*bytes*/) {
    throw py::type_error("an object without a value: call its class, not __new__");
}

/// pybind11 gives such objects memory that no constructor has filled, when they are first used.
void guard_classes(const py::module_& module) {
    for (const auto& [name, member] : py::dict(module.attr("__dict__")))
        if (py::isinstance<py::type>(member))
            if (auto* type =
                    py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(member.ptr())))
                type->operator_new = &refuse_uninitialised;
}

}  // namespace
}  // namespace stipple::python

PYBIND11_MODULE(_stipple, module) {
    using namespace stipple::python;
    module.doc() = "The compiled part of the package stipple.";
    module.attr("__version__") = stipple::version();
    bind_errors();
    bind_limits(module);
    bind_footage(module);
    bind_sensor(module);
    bind_schedule(module);
    bind_stream(module);
    bind_emulate(module);
    bind_chip(module);
    bind_decode(module);
    bind_denoiser(module);
    bind_forward_model(module);
    bind_compare(module);
    bind_measurements(module);
    bind_dictionary(module);
    bind_explore(module);
    bind_timing(module);
    bind_recording(module);
    bind_calibrate(module);
    bind_characterize(module);
    bind_camera(module);
    bind_camera_frames(module);
    bind_camera_search(module);
    bind_record(module);
    bind_report(module);
    bind_rig(module);
    bind_synth(module);
    bind_live_preview(module);
    bind_live(module);
    bind_training(module);
    bind_view(module);
    guard_classes(module);
}
