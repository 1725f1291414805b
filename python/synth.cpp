#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/memory_limit.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "study/scenes/scene.h"

namespace stipple::python {
namespace {

/// The frames of a scene.
py::array synth(const std::string& name, const SceneOptions& options, const py::object& tell) {
    const Scene scene(scene_from_name(name), options);
    const std::size_t sites = options.shape.sites();
    const auto slots = static_cast<std::size_t>(options.slots);
    check_memory(slots * sites * sizeof(float), "scene " + name, "the video");
    auto frames = std::make_unique<std::vector<float>>(slots * sites);
    CallProgress progress(tell, options.slots);
    {
        const py::gil_scoped_release released;
        for (int slot = 0; slot < options.slots; ++slot) {
            const std::size_t begin = static_cast<std::size_t>(slot) * sites;
            if (!scene.render(slot, std::span(*frames).subspan(begin, sites),
                              [&](double part) { return progress.reach(slot + part); }))
                break;
        }
    }
    progress.finish();
    return as_array(std::move(frames), options.shape);
}

SceneOptions scene_options(int slots, const py::object& size, const py::object& seed,
                           bool luminance) {
    const auto [rows, cols] = size_in(size, "size");
    return {.slots = slots,
            .shape = checked_shape(rows, cols, luminance ? 1 : 3, "size"),
            .seed = whole_in(seed, "seed")};
}

}  // namespace

void bind_synth(py::module_& module) {
    py::class_<SceneOptions>(module, "SceneOptions").def(py::init(&scene_options));
    module.def("synth", &synth);
}

}  // namespace stipple::python
