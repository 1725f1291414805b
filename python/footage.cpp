#include "python/footage.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "capture/recording/footage_notes.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "decoder/motion/lazy_opencv.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "readout/footage_origin.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

/// A path, or nothing: then it is an array, or like one.
std::optional<fs::path> path_of(const py::object& video) {
    if (!py::isinstance<py::str>(video) && !py::hasattr(video, "__fspath__")) return std::nullopt;
    return path_in(video, "video");
}

std::unique_ptr<ReadAhead> open(const fs::path& path, const FootageOptions& options,
                                std::vector<Message>& warnings) {
    const auto open_it = [&] {
        return std::make_unique<ReadAhead>(path, options,
                                           [&](const Message& text) { warnings.push_back(text); });
    };
    // Folders and printf patterns are no files.
    const bool is_file = path.string().find('%') == std::string::npos && !fs::is_directory(path);
    if (is_file) return reading(path, open_it);
    return open_it();
}

Reading reading_of(const std::optional<std::string>& transfer, bool luminance,
                   std::optional<double> max_value) {
    Reading reading{.options = {.luminance = luminance, .max_value = max_value}};
    if (max_value && !(static_cast<float>(*max_value) > 0))
        throw InputError("max_value", fmt::format("{} is not above 0", *max_value));
    if (transfer) reading.options.transfer = value_in(kTransfers, *transfer, "transfer");
    return reading;
}

void set_scale(Reading& reading, double scale) {
    constexpr auto kMin = static_cast<double>(std::numeric_limits<float>::min());
    constexpr auto kMax = static_cast<double>(std::numeric_limits<float>::max());
    if (!(scale >= kMin && scale <= kMax))
        throw InputError("scale", fmt::format("{} is outside {:.2g}..{:.2g}", scale, kMin, kMax));
    reading.options.scale = scale;
}

void set_min_value(Reading& reading, std::optional<double> light) {
    if (light && !(*light >= 0 && std::isfinite(static_cast<float>(*light))))
        throw InputError("min_value", fmt::format("{} is not 0 or above", *light));
    if (light && *light > reading.options.max_value.value_or(*light))
        throw InputError("min_value", fmt::format("{} is above max_value", *light));
    reading.options.min_value = light;
}

void set_rate(Reading& reading, std::optional<double> hz) {
    if (hz && !(*hz >= kMinFramesHz && *hz <= kMaxFramesHz))
        throw InputError("frames_hz",
                         fmt::format("{} is not {} to {}", *hz, kMinFramesHz, kMaxFramesHz));
    reading.options.frames_hz = hz;
}

void set_raw(Reading& reading, const std::optional<std::string>& text) {
    if (text) reading.options.raw = parse_raw_format(*text);
}

void set_part(Reading& reading, const std::optional<std::string>& frames,
              const std::optional<std::string>& crop, int bin, const py::object& resize) {
    FootagePart& part = reading.options.part;
    if (frames) part.frames = parse_frame_range(*frames);
    if (crop) part.crop = parse_crop_area(*crop);
    if (bin < 1 || bin > FootagePart::kMaxBin)
        throw InputError("bin", fmt::format("{} is not 1 to {}", bin, FootagePart::kMaxBin));
    part.bin = bin;
    if (resize.is_none()) return;
    const auto [rows, cols] = size_in(resize, "resize");
    part.size = checked_shape(rows, cols, 1, "resize");
}

void set_resampling(Reading& reading, const std::optional<std::string>& method) {
    if (!method) return;
    reading.resampling = value_in(kResamplings, *method, "resample");
    reading.options.at_their_times = true;
}

/// The flow between frames; OpenCV computes one at a time.
void flow_of(PlaneView<const float> from, PlaneView<const float> to, std::span<float> flow) {
    static std::mutex one;
    const std::scoped_lock lock(one);
    dis_flow(from, to, flow);
}

}  // namespace

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

void warn(const Message& text, int level) {
    if (!text.empty() && PyErr_WarnEx(PyExc_UserWarning, in_python(text).c_str(), level) != 0)
        throw py::error_already_set();
}

Footage::Footage(const py::object& video, Reading reading) : reading_(std::move(reading)) {
    if (const auto path = path_of(video)) {
        path_ = path->string();
        files_ = open(*path, reading_.options, warnings_);
    } else {
        if (py::module_::import("numpy.ma").attr("is_masked")(video).cast<bool>())
            throw InputError("video", "has masked values; give them light first: video.filled(0)");
        const auto array = py::array::ensure(video);
        if (!array) throw py::type_error("video: give an array or a path");
        array_.emplace(array, reading_.options);
    }
}

FrameShape Footage::shape() const {
    return files_ ? files_->shape() : array_->shape();
}

std::optional<std::int64_t> Footage::slots() const {
    if (!files_) return array_->slots();
    const auto slots = files_->slots();
    return slots ? std::optional<std::int64_t>(*slots) : std::nullopt;
}

ColourFilter Footage::filter() const {
    return files_ ? files_->filter() : ColourFilter::kNone;
}

std::span<const float> Footage::next() {
    return files_ ? files_->next() : array_->next();
}

std::string Footage::name() const {
    return path_.empty() ? "video" : path_;
}

ResampledFootage Footage::resampled(double slot_us) {
    return {FootageSource{.shape = shape(),
                          .filter = filter(),
                          .frames = slots(),
                          .frames_hz = files_ ? files_->frames_hz() : std::nullopt,
                          .next = [this] { return next(); },
                          .skip = {},
                          .time = files_ && files_->has_times()
                                      ? [this] { return files_->frame_time(); }
                                      : std::function<double()>()},
            name(),
            {.method = reading_.resampling,
             .frames_hz = reading_.options.frames_hz,
             .slot_us = slot_us,
             .flow = flow_of,
             .min_flow_side = kMinDisFlowSide}};
}

FootageOrigin Footage::origin() const {
    FootageOrigin origin{.name = "NumPy array", .reading = reading_.options};
    if (!path_.empty()) origin = origin_of(path_, reading_.options, check_signals);
    if (reading_.resampling) origin.resample = name_in(kResamplings, *reading_.resampling);
    return origin;
}

void Footage::warn_of(const SensorParams& sensor) const {
    if (!files_) return;
    for (const Message& text :
         sensor_notes(path_, *files_, sensor, reading_.resampling.has_value()))
        warn(text);
}

void Footage::pass_warnings_on(const SensorParams* sensor) {
    for (const Message& text : std::exchange(warnings_, {})) warn(text);
    if (array_) warn(array_->warning());
    if (!files_) return;
    if (sensor == nullptr) return warn(recording_note(path_, *files_));
    for (const Message& text : end_notes(path_, *files_, *sensor, reading_.resampling.has_value()))
        warn(text);
}

namespace {

/// All frames of footage, as light.
py::array load(Footage& footage, const py::object& tell) {
    auto frames = std::make_unique<std::vector<float>>();
    CallProgress progress(tell, footage.slots());
    {
        const py::gil_scoped_release released;
        double done = 0;
        for (auto frame = footage.next(); !frame.empty(); frame = footage.next()) {
            check_memory((frames->size() + frame.size()) * sizeof(float), footage.name(),
                         "the video");
            frames->insert(frames->end(), frame.begin(), frame.end());
            if (!progress.reach(++done)) break;
        }
    }
    progress.finish();
    footage.pass_warnings_on();
    return as_array(std::move(frames), footage.shape());
}

}  // namespace

void bind_footage(py::module_& module) {
    module.def("load", &load);
    py::class_<Reading>(module, "Reading")
        .def(py::init(&reading_of))
        .def("set_scale", &set_scale)
        .def("set_raw", &set_raw)
        .def("set_min_value", &set_min_value)
        .def("set_part", &set_part)
        .def("set_rate", &set_rate)
        .def("take_negative", [](Reading& reading) { reading.options.negative = true; })
        .def("set_resampling", &set_resampling);
    py::class_<Footage>(module, "Footage").def(py::init<const py::object&, Reading>());
}

}  // namespace stipple::python
