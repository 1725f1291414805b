#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/own_decoder.h"
#include "study/explore/exploration.h"
#include "study/explore/results.h"
#include "study/explore/rivals.h"

namespace stipple::python {
namespace {

/// Figures by their names; None where there is none.
py::dict dict_of_figures(const TrialFigures& figures) {
    py::dict dict;
    for (const FigureColumn& column : kFigureColumns) {
        const double value = figures.*column.value;
        dict[py::str(std::string(column.name))] =
            std::isnan(value) ? py::object(py::none()) : py::object(py::float_(value));
    }
    for (const TextColumn& column : kTextColumns)
        dict[py::str(std::string(column.name))] = figures.*column.value;
    return dict;
}

TrialFigures figures_of_dict(const py::dict& dict) {
    TrialFigures figures;
    for (const FigureColumn& column : kFigureColumns) {
        const py::object value = dict[py::str(std::string(column.name))];
        if (!value.is_none()) figures.*column.value = value.cast<double>();
    }
    for (const TextColumn& column : kTextColumns)
        figures.*column.value = dict[py::str(std::string(column.name))].cast<std::string>();
    return figures;
}

/// Figures, rows, columns, channels and bytes of the picture: what goes from a worker to the one
/// who asked.
using PlainOutcome = std::tuple<py::dict, int, int, int, py::bytes>;

PlainOutcome plain(const TrialOutcome& outcome) {
    const PngPixels& picture = outcome.picture;
    return {dict_of_figures(outcome.figures), picture.rows, picture.cols, picture.channels,
            py::bytes(reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size())};
}

TrialOutcome outcome_of(const PlainOutcome& plain) {
    const auto& [figures, rows, cols, channels, bytes] = plain;
    const std::string content = bytes;
    return {figures_of_dict(figures),
            {.rows = rows,
             .cols = cols,
             .channels = channels,
             .bytes = {content.begin(), content.end()}}};
}

/// An exploration that Ctrl-C ends.
class RunExploration {
  public:
    RunExploration(const std::filesystem::path& space, const std::filesystem::path& results,
                   ExploreOptions options, py::object tell)
        : space_(space), exploration_(space, results, std::move(options), [this] {
              return !progress_ || progress_->reach(done_);
          }) {
        progress_.emplace(std::move(tell), static_cast<std::int64_t>(exploration_.most_trials()));
    }

    bool next_rung() { return exploration_.next_rung(); }
    /// Whether the trial must be run.
    bool begin(std::uint64_t number) {
        const Trial* trial = nullptr;
        unlocked([&] { trial = exploration_.begin(number); });
        for (const Message& text : exploration_.take_warnings()) warn(text);
        if (trial == nullptr) advance();
        return trial != nullptr;
    }
    /// Runs the trial of the last `begin`, and takes its outcome.
    void run(std::uint64_t number) {
        try {
            unlocked([&] { put_or_fail(number); });
        } catch (const DecoderFault& fault) {
            throw py::value_error(fmt::format("{}; in {}", fault.what(), where(number)));
        } catch (DecoderRaised& raised) {
            raised.raise(" in " + where(number));
        }
        advance();
    }
    void put(std::uint64_t number, const PlainOutcome& outcome) {
        exploration_.put(number, outcome_of(outcome));
        advance();
    }
    void fail(std::uint64_t number, const std::string& problem) {
        exploration_.fail(number, problem);
        advance();
    }
    void write(bool report, const std::string& title) {
        exploration_.rank_points();
        write_tables(exploration_);
        if (report)
            exploration_.store().write(
                "report.html",
                results_page(exploration_, title.empty() ? space_.filename().string() : title, ""));
    }
    [[nodiscard]] py::list rows() const;
    [[nodiscard]] const Exploration& exploration() const { return exploration_; }

  private:
    void put_or_fail(std::uint64_t number) {
        try {
            const Trial& trial = exploration_.trial();
            const auto stream = exploration_.store().stream_of(trial.identity);
            exploration_.put(number, run_trial(trial, exploration_.light(), stream,
                                               [this] { return progress_->reach(done_); }));
        } catch (const InputError& e) {
            exploration_.fail(number, e.message());
        }
    }
    /// For messages: which trial.
    [[nodiscard]] std::string where(std::uint64_t number) const {
        const std::string name = exploration_.name_of(number);
        return fmt::format("trial {}{}", number + 1, name.empty() ? "" : " (" + name + ")");
    }
    template <typename Work>
    void unlocked(const Work& work) {
        try {
            const py::gil_scoped_release released;
            work();
        } catch (const TrialStopped&) {
            progress_->finish();  // raises what has stopped it
            throw;
        }
    }
    void advance() {
        ++done_;
        bool go_on = true;
        {
            const py::gil_scoped_release released;
            go_on = progress_->reach(done_);
        }
        if (!go_on) progress_->finish();
    }

    std::filesystem::path space_;
    std::optional<CallProgress> progress_;
    double done_ = 0;  ///< trials
    Exploration exploration_;
};

py::list RunExploration::rows() const {
    py::list rows;
    for (std::uint64_t number = 0; number < exploration_.points().size(); ++number) {
        if (!exploration_.points()[number].touched) continue;
        py::dict row;
        for (const auto& [column, value] : table_row(exploration_, number))
            row[py::str(column)] = value;
        rows.append(row);
    }
    return rows;
}

ExploreOptions options_of(bool force, const std::string& budget, const std::string& rank) {
    ExploreOptions options;
    options.force = force;
    options.rank = rank;
    options.wording = as_argument;
    if (!budget.empty()) {
        options.budget = parse_budget(budget);
        if (!options.budget)
            throw InputError("budget", fmt::format("\"{}\" is neither a time, as 90s, 10m or 2h, "
                                                   "nor a number of decoded clips",
                                                   budget));
    }
    return options;
}

void set_seeds(ExploreOptions& options, int seeds) {
    if (seeds < 1) throw InputError("seeds", fmt::format("{} is not 1 or more", seeds));
    options.seeds = seeds;
}

void add_decoder(ExploreOptions& options, const std::string& name, const std::string& version,
                 const py::object& decode) {
    options.methods.push_back(name);
    options.decoders.push_back(own_decoder(name, version, decode));
}

/// Returns the title of the page.
std::string choose_rivals(ExploreOptions& options, const std::string& footage,
                          const std::string& sensor, const std::vector<std::string>& systems,
                          const std::string& dictionary) {
    const RivalsChoice choice{footage, sensor, systems, dictionary};
    options.replaced = choice.replaced();
    return choice.title();
}

/// Number of a point, slots of the clip, and begin and end of those that are compared.
using PointOfClip = std::tuple<std::uint64_t, int, int, int>;

/// A trial on a worker: its identity and its outcome.
std::pair<std::string, PlainOutcome> run_point(const Space& space, const PointOfClip& point,
                                               const TrialLight& light,
                                               const std::filesystem::path& stream) {
    const auto& [number, slots, begin, end] = point;
    CallProgress progress(py::none(), std::nullopt);
    std::optional<Trial> trial;
    std::optional<TrialOutcome> outcome;
    try {
        const py::gil_scoped_release released;
        trial = set_up_trial(space, space.point(number), light, slots, {begin, end});
        outcome = run_trial(*trial, light, stream, [&] { return progress.reach(0); });
    } catch (const TrialStopped&) {
        progress.finish();
        throw;
    }
    return {trial->identity, plain(*outcome)};
}

TrialLight light_of(const Space& space, const std::string& footage) {
    CallProgress progress(py::none(), std::nullopt);
    try {
        const py::gil_scoped_release released;
        return read_light(space, footage, {}, [&] { return progress.reach(0); });
    } catch (const TrialStopped&) {
        progress.finish();
        throw;
    }
}

}  // namespace

void bind_explore(py::module_& module) {
    py::class_<ExploreOptions>(module, "ExploreOptions")
        .def(py::init(&options_of))
        .def("set_reading", [](ExploreOptions& options,
                               const Reading& reading) { options.reading = reading.options; })
        .def("set_seeds", &set_seeds)
        .def("add_method", [](ExploreOptions& options,
                              const std::string& method) { options.methods.push_back(method); })
        .def("add_decoder", &add_decoder)
        .def("choose_rivals", &choose_rivals);
    py::class_<RunExploration>(module, "Exploration")
        .def(py::init<const std::filesystem::path&, const std::filesystem::path&, ExploreOptions,
                      py::object>())
        .def("next_rung", &RunExploration::next_rung)
        .def("due", [](const RunExploration& run) { return run.exploration().due(); })
        .def("begin", &RunExploration::begin)
        .def("run", &RunExploration::run)
        .def("put", &RunExploration::put)
        .def("fail", &RunExploration::fail)
        .def("identity", [](const RunExploration& run,
                            std::uint64_t number) { return run.exploration().identity(number); })
        .def("write", &RunExploration::write)
        .def("rows", &RunExploration::rows)
        .def("point_of_clip",
             [](const RunExploration& run, std::uint64_t number) {
                 const ComparedSlots compared = run.exploration().compared();
                 return PointOfClip(number, run.exploration().slots(), compared.begin,
                                    compared.end);
             })
        .def("text", [](const RunExploration& run) { return run.exploration().space_text(); });
    py::class_<Space>(module, "Space")
        .def(py::init(&parse_space))
        .def("footage", [](const Space& space, std::uint64_t number) {
            return space.value(space.point(number), "footage");
        });
    py::class_<TrialLight>(module, "TrialLight").def(py::init(&light_of));
    module.def("is_scene", &is_scene);
    module.def("find_space", [](const std::string& name) {
        return find_config(ConfigKind::kSpaces, name).string();
    });
    module.def("run_point", &run_point);
}

}  // namespace stipple::python
