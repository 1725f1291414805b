#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "core/config.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/footage.h"
#include "python/sensor.h"
#include "python/stream.h"

namespace stipple::python {
namespace {

/// What is decoded, and how.
struct DecodeTask {
    DecodeOptions options;
    bool strict = false;
    std::optional<std::int64_t> until;  ///< slots; none: all
};

DecodeTask decode_task(const std::string& method, const py::dict& settings, bool fill_gaps,
                       bool strict, std::optional<std::int64_t> until) {
    if (until && *until < 1) throw InputError("until", fmt::format("{} is not above 0", *until));
    Config config(settings_of(settings), "decoder");
    DecodeTask task{.options = read_decode_options(decode_method_from_name(method), config),
                    .strict = strict,
                    .until = until};
    task.options.fill_gaps = fill_gaps;
    return task;
}

/// The frames, order (slot, plane, row, col), as an array that owns them: (slot, row, col), or of
/// colour (slot, row, col, plane), plane by plane in memory.
py::array as_array(std::unique_ptr<std::vector<float>> frames, FrameShape shape) {
    const auto slots = static_cast<py::ssize_t>(frames->size() / shape.sites());
    const py::capsule owner(frames.get(),
                            [](void* memory) { delete static_cast<std::vector<float>*>(memory); });
    float* const data = frames.release()->data();
    if (shape.planes == 1)
        return py::array_t<float>({slots, py::ssize_t{shape.rows}, py::ssize_t{shape.cols}}, data,
                                  owner);
    const py::array_t<float> planar(
        {slots, py::ssize_t{shape.planes}, py::ssize_t{shape.rows}, py::ssize_t{shape.cols}}, data,
        owner);
    return py::array(planar.attr("transpose")(0, 2, 3, 1));
}

/// Without the GIL.
void decode_frames(StreamReader& reader, const DecodeTask& task, CallProgress& progress,
                   std::vector<float>& frames) {
    const FrameShape shape = decoded_shape(reader.header());
    const auto known = reader.slots();
    const auto slots = task.until ? std::min(*task.until, known.value_or(*task.until)) : known;
    if (known) {
        const std::uint64_t values = static_cast<std::uint64_t>(*slots) * shape.sites();
        check_memory(values * sizeof(float), task.options.where, "the decoded video");
        frames.reserve(values);
    }
    decode(
        reader, task.options,
        [&](std::int64_t slot, std::span<const float> frame) {
            frames.insert(frames.end(), frame.begin(), frame.end());
            return !task.until || slot + 1 < *task.until;
        },
        [&](double done) { return progress.reach(done); });
}

py::array decode_stream(const StreamFile& stream, DecodeTask task, const py::object& tell) {
    task.options.where = stream.name();
    task.options.input_bytes = input_bytes(stream.path());
    StreamReader reader = stream.reader(task.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant);
    auto total = reader.slots();
    if (task.until) total = std::min(*task.until, total.value_or(*task.until));
    CallProgress progress(tell, total);
    auto frames = std::make_unique<std::vector<float>>();
    {
        const py::gil_scoped_release released;
        decode_frames(reader, task, progress, *frames);
    }
    progress.finish();
    if (frames->empty()) throw InputError(stream.name(), "holds no slot to decode");
    const std::string damage = damage_text(reader.report());
    if (!damage.empty())
        warn(fmt::format("{}: {}\n  the output is made of what is left", stream.name(), damage));
    else if (reader.report().samples == 0)
        warn(fmt::format("{}: holds no sample, so the frames are black", stream.name()));
    return as_array(std::move(frames), decoded_shape(reader.header()));
}

}  // namespace

void bind_decode(py::module_& module) {
    py::class_<DecodeTask>(module, "DecodeTask").def(py::init(&decode_task));
    module.def("decode", &decode_stream);
    module.def("decode_methods", [] {
        std::vector<std::string> names;
        for (const NamedDecodeMethod& method : decode_methods()) names.emplace_back(method.name);
        return names;
    });
}

}  // namespace stipple::python
