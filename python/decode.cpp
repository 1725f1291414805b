#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "calibration/calibration_file.h"
#include "core/config.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "decoder/block_partition.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "explore/dictionary_file.h"
#include "io/npy_header.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/sensor.h"
#include "python/stream.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_identity.h"

namespace stipple::python {
namespace {

/// What is decoded, and how.
struct DecodeTask {
    DecodeOptions options;
    std::string given;  ///< options of the method that were given, as lines of TOML
    bool strict = false;
    std::optional<std::int64_t> until;                      ///< slots; none: all
    std::optional<std::filesystem::path> calibration = {};  ///< file or "none"; no value: beside
};

DecodeTask decode_task(const py::object& method, const py::dict& settings, bool fill_gaps,
                       bool strict, std::optional<std::int64_t> until) {
    if (until && *until < 1) throw InputError("until", fmt::format("{} is not above 0", *until));
    if (!py::isinstance<py::str>(method))
        throw py::type_error(fmt::format("method: {} is not a text", short_text(method)));
    Config config(settings_of(settings), "decoder");
    DecodeTask task{
        .options = read_decode_options(decode_method_from_name(method.cast<std::string>()), config),
        .given = config.as_toml(""),
        .strict = strict,
        .until = until};
    if (task.options.method == DecodeMethod::kHitomi2011 &&
        task.options.hitomi2011.dictionary_file.empty())
        throw InputError("options",
                         "hitomi2011 needs {\"dictionary\": FILE}, which a command makes: "
                         "stipple dictionary FOOTAGE -o FILE.npy");
    reading(task.options.hitomi2011.dictionary_file, [&] { read_dictionary(task.options); });
    task.options.fill_gaps = fill_gaps;
    return task;
}

/// What the user should know of a stream that was decoded to its end, or to `until`.
std::string warning_of(const StreamReport& report, bool to_end) {
    if (std::string damage = decoded_damage_text(report); !damage.empty()) return damage;
    if (std::string empty = no_sample_text(report); !empty.empty()) return empty;
    return to_end ? no_end_text(report) : "";
}

/// The calibration of a stream's chip.
ChipCalibration read_calibration(const std::filesystem::path& file, const StreamHeader& header) {
    const auto bytes = reading(file, [&] { return read_file(file); });
    ChipCalibration calibration = decode_chip_calibration(bytes, file.string());
    const ChipOrigin chip = chip_of(header.provenance);
    require_same_chip(calibration, header, {.name = chip.name, .device_id = chip.device_id},
                      file.string());
    return calibration;
}

/// Uses the calibration that is given, or the one beside the stream.
void calibrate(StreamReader& reader, const StreamFile& stream, const DecodeTask& task) {
    const std::filesystem::path file =
        task.calibration ? *task.calibration : calibration_beside(stream.path());
    if (file.empty() || file == "none") return;
    ChipCalibration calibration = read_calibration(file, reader.header());
    reader.use_sites(std::move(calibration.sites), std::move(calibration.response));
}

/// Appends the frames that are decoded. Without the GIL.
void decode_frames(StreamReader& reader, const DecodeTask& task, CallProgress& progress,
                   std::vector<float>& frames) {
    decode(
        reader, task.options,
        [&](std::int64_t slot, std::span<const float> frame) {
            frames.insert(frames.end(), frame.begin(), frame.end());
            return !task.until || slot + 1 < *task.until;
        },
        [&](double done) { return progress.reach(done); });
}

py::array decode_stream(const StreamFile& stream, const DecodeTask& task, const py::object& tell) {
    StreamReader reader = stream.reader(task.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant);
    calibrate(reader, stream, task);
    const FrameShape shape = decoded_shape(reader.header());
    const auto known = reader.slots();
    const auto slots = task.until ? std::min(*task.until, known.value_or(*task.until)) : known;
    auto frames = std::make_unique<std::vector<float>>();
    if (known) {
        const std::int64_t frame_count =
            std::max<std::int64_t>(*slots - task.options.first_slot, 0);
        const std::uint64_t values = static_cast<std::uint64_t>(frame_count) * shape.sites();
        check_memory(values * sizeof(float), stream.name(), "the decoded video");
        frames->reserve(values);
    }
    CallProgress progress(tell, slots);
    {
        const py::gil_scoped_release released;
        decode_frames(reader, task, progress, *frames);
    }
    progress.finish();
    if (frames->empty()) throw InputError(stream.name(), "holds no slot to decode");
    const std::string warning = warning_of(reader.report(), !task.until);
    if (!warning.empty()) warn(fmt::format("{}: {}", stream.name(), warning));
    return as_array(std::move(frames), shape);
}

/// The header of a window of "stipple decode --part": of its number, its slots, rows, columns and
/// planes, and the text of decoding.json.
py::bytes window_header(std::int64_t number, const std::array<int, 4>& sizes,
                        const std::string& identity) {
    const auto& [slots, rows, cols, planes] = sizes;
    return format_npy_header(slots, {rows, cols, planes}, window_mark(number, identity));
}

}  // namespace

void bind_decode(py::module_& module) {
    py::class_<DecodeTask>(module, "DecodeTask")
        .def(py::init(&decode_task))
        .def_readwrite("calibration", &DecodeTask::calibration)
        .def_readonly("given", &DecodeTask::given)
        .def("begin_at_block", [](DecodeTask& task, std::int64_t number) {
            task.options.first_slot = block_begin(number);
        });
    module.def("decode_blocks", &block_count);
    module.def("block_begin", &block_begin);
    module.def("stream_identity", &stream_identity);
    module.def("window_header", &window_header);
    module.def("decode", &decode_stream);
    module.def("decode_methods", [] {
        std::vector<std::string> names;
        for (const NamedDecodeMethod& method : decode_methods()) names.emplace_back(method.name);
        return names;
    });
}

}  // namespace stipple::python
