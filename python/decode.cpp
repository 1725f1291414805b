#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "decoder/block_partition.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/denoiser.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/refiner.h"
#include "python/sensor.h"
#include "python/stream.h"
#include "session/decode_session.h"
#include "session/rig_folder.h"
#include "session/video_shards.h"
#include "stream/stream_figures.h"

namespace stipple::python {
namespace {

/// What is decoded, and how.
struct DecodeTask {
    DecodeSetup setup;
    bool strict = false;
    std::optional<std::int64_t> until;                      ///< slots; none: all
    std::optional<std::filesystem::path> calibration = {};  ///< as calibration_choice

    [[nodiscard]] ReadPolicy policy() const {
        return strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant;
    }
};

DecodeTask decode_task(const py::object& method, const py::dict& settings, bool fill_gaps,
                       bool strict, std::optional<std::int64_t> until) {
    if (until && *until < 1) throw InputError("until", fmt::format("{} is not above 0", *until));
    if (!py::isinstance<py::str>(method))
        throw py::type_error(fmt::format("method: {} is not a text", short_text(method)));
    DecodeTask task{
        .setup = decode_setup(method.cast<std::string>(), Config(settings_of(settings), "decoder")),
        .strict = strict,
        .until = until};
    DecodeOptions& options = task.setup.options;
    const std::string& dictionary = options.hitomi2011.dictionary_file;
    if (options.method == DecodeMethod::kHitomi2011 && dictionary.empty())
        throw InputError("options",
                         "hitomi2011 needs {\"dictionary\": FILE}, which a command makes: "
                         "stipple dictionary FOOTAGE -o FILE.npy");
    reading(option_file(options), [&] { read_option_file(options); });
    options.fill_gaps = fill_gaps;
    return task;
}

void set_denoiser(DecodeTask& task, const py::object& call) {
    DecodeOptions& options = task.setup.options;
    if (options.method != DecodeMethod::kPlugAndPlay)
        throw InputError("denoiser", fmt::format("is for the method plug_and_play, not for {}",
                                                 named(options.method).name));
    if (options.plug_and_play.denoiser)
        throw InputError("denoiser", "is given twice, as a function and as an option");
    options.plug_and_play.denoiser = python_denoiser(call);
}

void set_refiner(DecodeTask& task, const py::object& call) {
    DecodeOptions& options = task.setup.options;
    if (options.method != DecodeMethod::kLearned && options.method != DecodeMethod::kLearnedFast)
        throw InputError("refiner", fmt::format("is for the methods learned and learned_fast, not "
                                                "for {}",
                                                named(options.method).name));
    if (!options.learned.model_file.empty())
        throw InputError("refiner", "is given twice, as a function and as an option");
    options.learned.refine = python_refiner(call);
}

/// What the user should know of a stream that was decoded to its end, or to `until`.
std::string warning_of(const StreamReport& report, bool to_end) {
    if (std::string damage = decoded_damage_text(report); !damage.empty()) return damage;
    if (std::string empty = no_sample_text(report); !empty.empty()) return empty;
    return to_end ? no_end_text(report) : "";
}

/// The session of a stream. \throws FileError where the calibration cannot be opened.
DecodeSession session_of(const StreamFile& stream, const DecodeTask& task) {
    CalibrationChoice calibration;
    if (task.calibration)
        calibration = calibration_choice(*task.calibration);
    else if (stream.is_temporary())
        calibration.emplace();  // nothing lies beside it
    const auto open = [&] {
        return DecodeSession(stream.reader(task.policy()), task.setup, calibration);
    };
    return calibration && !calibration->empty() ? reading(*calibration, open) : open();
}

/// Of one stream or a rig, which messages call `name`.
py::array decode_session(DecodeSession session, const std::string& name, const DecodeTask& task,
                         const py::object& tell) {
    if (task.until) session.end_after(*task.until);
    for (const Message& warning : session.warnings()) warn(warning);
    auto frames = std::make_unique<std::vector<float>>();
    if (const auto count = session.frames()) {
        const std::uint64_t values = static_cast<std::uint64_t>(*count) * session.shape().sites();
        check_memory(values * sizeof(float), name, "the decoded video");
        frames->reserve(values);
    }
    CallProgress progress(tell, session.frames());
    {
        const py::gil_scoped_release released;
        session.run(
            [&](std::int64_t, std::span<const float> frame) {
                frames->insert(frames->end(), frame.begin(), frame.end());
                return true;
            },
            [&](double done) { return progress.reach(done); });
    }
    progress.finish();
    const bool is_rig = session.streams().size() > 1;
    for (const StreamReader& stream : session.streams()) {
        const std::string warning = warning_of(stream.report(), !task.until);
        if (!warning.empty()) warn(fmt::format("{}: {}", is_rig ? stream.name() : name, warning));
    }
    return as_array(std::move(frames), session.shape());
}

py::array decode_stream(const StreamFile& stream, const DecodeTask& task, const py::object& tell) {
    return decode_session(session_of(stream, task), stream.name(), task, tell);
}

/// Of the streams in the folder of a rig.
py::array decode_rig(const std::filesystem::path& folder, const DecodeTask& task,
                     const py::object& tell) {
    if (task.calibration)
        throw InputError("calibration", "is of one stream, but " + folder.string() +
                                            " is the folder of a rig; leave it out");
    return decode_session({open_rig_folder(folder, task.policy(), check_signals), task.setup},
                          folder.string(), task, tell);
}

/// Files of a sharded decoding, as its folder has them.
class PythonShards {
  public:
    PythonShards(const std::filesystem::path& folder, const std::string& identity)
        : folder_(folder, parse_identity(identity, folder)) {}

    void claim() { folder_.claim(); }
    [[nodiscard]] bool claimed() const { return folder_.claimed(); }
    [[nodiscard]] bool holds(std::int64_t number) const { return folder_.windows().holds(number); }
    void write(std::int64_t number, const py::array_t<float, py::array::c_style>& frames) {
        folder_.claim();
        VideoShards::Writer window(folder_, number);
        const std::span<const float> values(frames.data(), static_cast<std::size_t>(frames.size()));
        const std::size_t sites = folder_.identity().shape.sites();
        for (std::size_t begin = 0; begin < values.size(); begin += sites)
            window.write(values.subspan(begin, sites));
    }

  private:
    VideoShards folder_;
};

/// decoding.json of a decoding on workers.
std::string decoding_identity(const std::filesystem::path& stream, const DecodeTask& task) {
    const ShardedDecoding decoding{.stream = stream,
                                   .setup = task.setup,
                                   .calibration = task.calibration
                                                      ? calibration_choice(*task.calibration)
                                                      : CalibrationChoice()};
    return identity_text(identity_of(decoding, check_signals));
}

}  // namespace

void bind_decode(py::module_& module) {
    py::class_<DecodeTask>(module, "DecodeTask")
        .def(py::init(&decode_task))
        .def_readwrite("calibration", &DecodeTask::calibration)
        .def("set_denoiser", &set_denoiser)
        .def("set_refiner", &set_refiner)
        .def("begin_at_block", [](DecodeTask& task, std::int64_t number) {
            task.setup.options.first_slot = block_begin(number);
        });
    module.def("decode_blocks", &block_count);
    module.def("block_begin", &block_begin);
    module.def("decoding_identity", &decoding_identity);
    py::class_<PythonShards>(module, "VideoShards")
        .def(py::init<std::filesystem::path, std::string>())
        .def("claim", &PythonShards::claim)
        .def("claimed", &PythonShards::claimed)
        .def("holds", &PythonShards::holds)
        .def("write", &PythonShards::write);
    module.def("decode", &decode_stream);
    module.def("decode_rig", &decode_rig);
    module.def("decode_methods", [] {
        std::vector<std::string> names;
        for (const NamedDecodeMethod& method : decode_methods()) names.emplace_back(method.name);
        return names;
    });
}

}  // namespace stipple::python
