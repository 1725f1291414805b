#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/memory_limit.h"
#include "decoder/decode_method.h"
#include "io/output_names.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/own_decoder.h"
#include "study/report/camera_file.h"
#include "study/report/stream_report.h"

namespace stipple::python {
namespace {

/// Thrown where CallProgress has said so.
struct Stopped {};

void set_limits(StreamReportTask& task, std::int64_t until, const std::optional<std::string>& crop,
                const std::optional<std::string>& max_size) {
    constexpr std::int64_t kMaxSlots = 100'000;
    if (until < 1 || until > kMaxSlots)
        throw InputError("until", fmt::format("{} is not 1 to {}", until, kMaxSlots));
    task.page.slots = until;
    if (crop) task.page.area = parse_area(*crop);
    if (crop && !task.page.area)
        throw InputError("crop", "\"" + *crop + "\" is not WxH or WxH+X+Y in pixels");
    if (!max_size) return;
    const auto bytes = parse_memory(*max_size);
    if (!bytes) throw InputError("max_size", "\"" + *max_size + "\" is not 1M or more");
    task.page.max_bytes = *bytes;
}

void set_max_value(StreamReportTask& task, std::optional<double> light) {
    if (light && !(*light > 0))
        throw InputError("max_value", fmt::format("{} is not above 0", *light));
    task.page.quality.max_value = light;
}

ReportTruth truth_of(Footage& footage) {
    return {.name = footage.name(),
            .shape = footage.shape(),
            .bytes = kEndlessInput,
            .next = [&footage] { return footage.next(); }};
}

/// The figures, JSON text.
std::string report(StreamReportTask task, Footage* truth, const py::object& tell) {
    check_name(task.output, kPageName);
    if (truth != nullptr) task.truth = truth_of(*truth);
    CallProgress progress(tell, std::nullopt);
    double before = 0, done = 0;
    std::string decoding;
    const ReportCalls calls{.check =
                                [&] {
                                    if (!progress.reach(before + done)) throw Stopped();
                                },
                            .begin =
                                [&](const std::string& what, std::int64_t /*slots*/) {
                                    decoding = what;
                                    before += std::exchange(done, 0);
                                    return [&](double slots) {
                                        done = slots;
                                        return progress.reach(before + done);
                                    };
                                }};
    StreamReportResult made;
    try {
        const py::gil_scoped_release released;
        made = report_streams(std::move(task), calls);
    } catch (const Stopped&) {
        progress.finish();
        throw;
    } catch (const DecoderFault& fault) {
        throw py::value_error(fmt::format("{}; in {}", fault.what(), decoding));
    } catch (DecoderRaised& raised) {
        raised.raise(" in " + decoding);
    }
    progress.finish();
    if (truth != nullptr) truth->pass_warnings_on();
    for (const std::string& note : made.notes) warn(note);
    warn(chart_warning());
    if (!made.damage.empty()) warn("only the undamaged part of damaged streams: " + made.damage);
    return made.figures;
}

}  // namespace

void bind_report(py::module_& module) {
    py::class_<StreamReportTask>(module, "ReportTask")
        .def(py::init([](const std::vector<std::string>& runs, const std::filesystem::path& output,
                         bool force, const std::string& title) {
            return StreamReportTask{.runs = runs,
                                    .output = output,
                                    .force = force,
                                    .methods = {},
                                    .page = {.title = title}};
        }))
        .def("set_limits", &set_limits)
        .def("set_max_value", &set_max_value)
        .def("set_camera", [](StreamReportTask& task,
                              const std::string& file) { task.camera = read_camera_file(file); })
        .def("add_method",
             [](StreamReportTask& task, const std::string& method) {
                 task.methods.emplace_back(decode_method_from_name(method));
             })
        .def("add_decoder", [](StreamReportTask& task, const std::string& name,
                               const std::string& version, const py::object& decode) {
            task.methods.emplace_back(own_decoder(name, version, decode));
        });
    module.def("report", &report);
}

}  // namespace stipple::python
