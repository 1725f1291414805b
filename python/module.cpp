#include "core/version.h"
#include "python/bindings.h"

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
    bind_decode(module);
    bind_compare(module);
    bind_explore(module);
    bind_timing(module);
    bind_recording(module);
    bind_characterize(module);
    bind_camera(module);
    bind_camera_frames(module);
    bind_camera_search(module);
    bind_record(module);
    bind_live_preview(module);
    bind_live(module);
}
