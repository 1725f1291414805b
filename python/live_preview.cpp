#include "python/live_preview.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "python/bindings.h"
#include "python/footage.h"

namespace stipple::python {
namespace {

using namespace pybind11::literals;

/// A decoded frame as Python sees it.
struct FrameArrays {
    std::int64_t slot;
    py::array light;
    py::array saturated;
};

FrameArrays arrays_of(const PreviewFrame& frame) {
    py::array_t<bool> saturated({frame.shape.rows, frame.shape.cols});
    std::copy(frame.saturated.begin(), frame.saturated.end(), saturated.mutable_data());
    const py::array one_slot =
        as_array(std::make_unique<std::vector<float>>(frame.light), frame.shape);
    return {frame.slot, one_slot.attr("__getitem__")(0), std::move(saturated)};
}

LivePreviewOptions options_of(std::function<void(const PreviewFrame&)> keep,
                              const std::atomic<bool>& stopped, SessionWarnings& warnings) {
    return {.show = std::move(keep),
            .tell =
                [&warnings](const Message& failure) {
                    warnings.take("no preview: " + failure + "; the recording goes on");
                },
            .keep_going = [&stopped] { return !stopped; }};
}

PreviewTask task_of(py::object show, const std::string& method,
                    const std::optional<std::pair<int, int>>& size) {
    constexpr int kMinSide = 8;
    if (!PyCallable_Check(show.ptr()))
        throw py::type_error("preview: give a function that takes a PreviewFrame");
    if (method != "naive" && method != "live" && method != "fast")
        throw InputError("preview_method",
                         fmt::format("\"{}\" is none of naive, live, fast", method));
    PreviewTask task{std::move(show), {.method = decode_method_from_name(method), .size = {}}};
    if (!size) return task;
    const auto [rows, cols] = *size;
    if (std::min(rows, cols) < kMinSide || std::max(rows, cols) > kMaxFrameSide)
        throw InputError("preview_size", fmt::format("({}, {}) is outside {}..{}", rows, cols,
                                                     kMinSide, kMaxFrameSide));
    task.options.size = FrameShape{.rows = rows, .cols = cols};
    return task;
}

}  // namespace

ShownPreview::ShownPreview(PreviewTask task, StreamHeader header, SessionWarnings& warnings)
    : show_(std::move(task.show)),
      preview_(std::move(header), task.options,
               options_of([this](const PreviewFrame& frame) { keep(frame); }, stopped_, warnings)) {
}

void ShownPreview::keep(const PreviewFrame& frame) {
    const std::lock_guard lock(mutex_);
    newest_ = frame;
}

void ShownPreview::call(const PreviewFrame& frame) {
    const py::gil_scoped_acquire gil;
    try {
        show_(arrays_of(frame));
    } catch (...) {
        raised_ = std::current_exception();
        stopped_ = true;
    }
}

bool ShownPreview::pass_on() noexcept {
    if (raised_) return false;
    std::optional<PreviewFrame> frame;
    {
        const std::lock_guard lock(mutex_);
        frame.swap(newest_);
    }
    if (frame) call(*frame);
    return !raised_;
}

void ShownPreview::finish(bool give_up) {
    if (give_up) stopped_ = true;
    const auto ended = std::async(std::launch::async, [this] { preview_.finish([] {}); });
    while (ended.wait_for(kSignalInterval) != std::future_status::ready) {
        const py::gil_scoped_acquire gil;
        if (raised_ || PyErr_CheckSignals() == 0) continue;
        raised_ = std::make_exception_ptr(py::error_already_set());
        stopped_ = true;
    }
    if (!give_up) static_cast<void>(pass_on());
}

void ShownPreview::throw_raised() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

py::dict ShownPreview::figures() const {
    const FrameShape shape = preview_.decoder().shape();
    const PreviewCounts counts = preview_.counts();
    py::dict dict("width"_a = shape.cols, "height"_a = shape.rows,
                  "slots"_a = preview_.decoder().slots(), "made"_a = counts.made,
                  "failed"_a = counts.failed, "skipped_slots"_a = counts.skipped_slots,
                  "last_slot"_a = py::none(), "delay_ms"_a = py::none());
    if (counts.made == 0) return dict;
    dict["last_slot"] = counts.last_slot;
    dict["delay_ms"] = py::dict("median"_a = counts.delays.quantile_us(0.5) * 1e-3,
                                "max"_a = counts.delays.longest_us() * 1e-3);
    return dict;
}

void bind_live_preview(py::module_& module) {
    py::class_<FrameArrays>(module, "PreviewFrame",
                            "A decoded frame of a stream that is being recorded.")
        .def_readonly("slot", &FrameArrays::slot, "Its slot.")
        .def_readonly("light", &FrameArrays::light,
                      "Linear light, float32, (row, col), of colour (row, col, 3), in the unit of\n"
                      "stipple.decode.")
        .def_readonly(
            "saturated", &FrameArrays::saturated,
            "Whether all samples of a colour of a pixel are saturated: bool, (row, col).");
    py::class_<PreviewTask>(module, "PreviewTask").def(py::init(&task_of));
}

}  // namespace stipple::python
