#include "decoder/forward_model.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "decoder/data_prox.h"
#include "python/bindings.h"
#include "python/schedule.h"
#include "python/stream.h"
#include "readout/emulator.h"

namespace stipple::python {
namespace {

using Array = py::array_t<float, py::array::c_style>;
constexpr char kArray[] = "ForwardModel";

void check_window(std::int64_t slots, FrameShape shape) {
    if (slots < 1) throw InputError("slots", fmt::format("{} is not above 0", slots));
    check_memory(static_cast<std::uint64_t>(slots) * shape.sites() * 9, kArray, "the samples");
}

std::unique_ptr<ForwardModel> model_of_stream(const StreamFile& stream, std::int64_t first_slot,
                                              std::optional<std::int64_t> slots) {
    StreamReader reader = stream.reader();
    const FrameShape shape = decoded_shape(stream.header());
    std::vector<SamplePacket> packets;
    const std::int64_t end = slots ? first_slot + *slots : first_slot + kMaxRunSlots;
    std::int64_t last = first_slot;
    for (SamplePacket packet; reader.next(packet) && packet.slot < end;) {
        last = packet.slot + 1;
        if (packet.slot >= first_slot) packets.push_back(packet);
    }
    const std::int64_t count = slots ? *slots : last - first_slot;
    check_window(count, shape);
    return std::make_unique<ForwardModel>(
        collect_measurements(
            reader.header(), packets,
            {.first_slot = first_slot, .slots = static_cast<int>(count), .shape = shape}),
        reader.header().calibration);
}

/// All due samples, without light.
std::unique_ptr<ForwardModel> model_of_sensor(const py::object& schedule, const py::object& sensor,
                                              std::int64_t slots, const FrameShape& shape) {
    check_window(slots, shape);
    const SensorSetup setup =
        set_up(with_seed_of(schedule, sensor_of(sensor)), schedule, shape, ColourFilter::kNone);
    const StreamHeader header = stream_header_of(setup, "");
    std::vector<SamplePacket> packets;
    for (std::int64_t slot = 0; slot < slots; ++slot) {
        packets.push_back({slot, 0, setup.shape.rows, 0, {}});
        packets.back().dn.resize(index(setup.shape.planes) * count_due(header.schedule, slot, 0,
                                                                       setup.shape.rows,
                                                                       setup.shape.cols));
    }
    auto model = std::make_unique<ForwardModel>(
        collect_measurements(header, packets,
                             {.slots = static_cast<int>(slots), .shape = decoded_shape(header)}),
        header.calibration);
    model->set_samples(std::vector<float>(model->samples().size()));
    return model;
}

std::vector<py::ssize_t> dimensions(const ForwardModel& model) {
    const FrameShape shape = model.shape();
    if (shape.planes == 1) return {model.slots(), shape.rows, shape.cols};
    return {model.slots(), shape.planes, shape.rows, shape.cols};
}

/// No value is below `min`, infinite or NaN. Without an early end, which would keep it from vector
/// instructions.
bool are_finite(std::span<const float> values, float min = std::numeric_limits<float>::lowest()) {
    constexpr std::size_t kPart = 65536;
    std::atomic<bool> right = true;
    parallel_for(0, static_cast<int>((values.size() + kPart - 1) / kPart), [&](int part) {
        const std::size_t begin = index(part) * kPart;
        unsigned wrong = 0;
        for (const float value : values.subspan(begin, std::min(kPart, values.size() - begin)))
            wrong |= value >= min && value <= std::numeric_limits<float>::max() ? 0U : 1U;
        if (wrong != 0) right = false;
    });
    return right;
}

/// The values of an array of the shape of the model.
std::span<const float> values_of(const ForwardModel& model, const Array& array, const char* name) {
    const std::vector<py::ssize_t> wanted = dimensions(model);
    if (!std::equal(wanted.begin(), wanted.end(), array.shape(), array.shape() + array.ndim()))
        throw InputError(name,
                         fmt::format("has the shape ({}), not ({})",
                                     fmt::join(array.shape(), array.shape() + array.ndim(), ", "),
                                     fmt::join(wanted, ", ")));
    const std::span<const float> values(array.data(), static_cast<std::size_t>(array.size()));
    if (!are_finite(values)) throw InputError(name, "has values that are not finite");
    return values;
}

std::span<float> values_of(Array& array) {
    return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// result = operation(array), both of the shape of the model.
template <auto kOperation>
Array mapped(const ForwardModel& model, const Array& array) {
    const std::span<const float> values = values_of(model, array, "array");
    Array result(dimensions(model));
    const std::span<float> to = values_of(result);
    const py::gil_scoped_release released;
    (model.*kOperation)(values, to);
    return result;
}

/// A step for each slot and pixel: the values of `step`, or its one value, which `kept` repeats.
std::span<const float> steps_of(const ForwardModel& model, const Array& step,
                                std::vector<float>& kept) {
    const std::size_t values = index(model.slots()) * model.shape().pixels();
    const std::span<const float> steps(step.data(), static_cast<std::size_t>(step.size()));
    if (steps.size() != 1 && steps.size() != values)
        throw InputError("step", fmt::format("has {} values, neither 1 nor {}, one for each slot "
                                             "and pixel",
                                             step.size(), values));
    if (!are_finite(steps, 0))
        throw InputError("step", "has values that are negative or not finite");
    if (steps.size() == values) return steps;
    kept.assign(values, steps[0]);
    return kept;
}

Array prox(const ForwardModel& model, const Array& v, const Array& step) {
    const std::span<const float> values = values_of(model, v, "v");
    std::vector<float> kept;
    const std::span<const float> steps = steps_of(model, step, kept);
    Array result(dimensions(model));
    const std::span<float> to = values_of(result);
    const py::gil_scoped_release released;
    const std::size_t sites = model.shape().sites();
    parallel_for(0, model.slots(), [&](int slot) {
        std::ranges::copy(values.subspan(index(slot) * sites, sites), &to[index(slot) * sites]);
    });
    model.prox(steps, to);
    return result;
}

/// Which voxels have a bit of the state.
template <std::uint8_t kBit>
py::array_t<bool> voxels_with(const ForwardModel& model) {
    py::array_t<bool> array(dimensions(model));
    std::ranges::transform(model.measurements().state, array.mutable_data(),
                           [](std::uint8_t state) { return (state & kBit) != 0; });
    return array;
}

}  // namespace

void bind_forward_model(py::module_& module) {
    py::class_<ForwardModel>(module, "ForwardModel")
        .def_static("of_stream", &model_of_stream)
        .def_static("of_sensor",
                    [](const py::object& schedule, const py::object& sensor,
                       const std::array<int, 4>& size) {
                        return model_of_sensor(
                            schedule, sensor, size[0],
                            {.rows = size[1], .cols = size[2], .planes = size[3]});
                    })
        .def("planes", [](const ForwardModel& model) { return model.shape().planes; })
        .def("shape",
             [](const ForwardModel& model) { return py::tuple(py::cast(dimensions(model))); })
        .def("samples",
             [](const ForwardModel& model) {
                 return Array(dimensions(model), model.samples().data());
             })
        .def("states",
             [](const ForwardModel& model) {
                 return py::array_t<std::uint8_t>(dimensions(model),
                                                  model.measurements().state.data());
             })
        .def("is_sample", &voxels_with<Measurements::kLast>)
        .def("is_saturated", &voxels_with<Measurements::kSaturated>)
        .def("is_zero", &voxels_with<Measurements::kZero>)
        .def("set_samples", [](ForwardModel& model,
                               const Array& y) { model.set_samples(values_of(model, y, "y")); })
        .def("set_variances", [](ForwardModel& model,
                                 const Array& x) { model.set_variances(values_of(model, x, "x")); })
        .def("variances",
             [](const ForwardModel& model) {
                 return Array(dimensions(model), model.measurements().variance.data());
             })
        .def("forward", &mapped<&ForwardModel::forward>)
        .def("adjoint", &mapped<&ForwardModel::adjoint>)
        .def("noise_variance", &mapped<&ForwardModel::noise_variance>)
        .def("score", &mapped<&ForwardModel::score>)
        .def("prox", &prox)
        .def("log_likelihood", [](const ForwardModel& model, const Array& x) {
            const std::span<const float> values = values_of(model, x, "x");
            const py::gil_scoped_release released;
            return model.log_likelihood(values);
        });
}

}  // namespace stipple::python
