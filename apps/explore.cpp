#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/explore_space.h"
#include "apps/explore_trial.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/text_file.h"
#include "apps/subcommands.h"
#include "capture/payload_hash.h"
#include "core/error.h"
#include "core/version.h"
#include "io/disk_sync.h"
#include "io/partial_output.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

struct ExploreArguments {
    std::string space;
    std::string results;
};

/// The folder of results: a file per trial, named after the hash of what determines it, and the
/// table.
class Results {
  public:
    /// Makes the folder if it is missing. \throws InputError if it holds something else or the
    /// results of another version.
    explicit Results(fs::path folder);

    /// The figures of a trial that was run before.
    [[nodiscard]] std::optional<ordered_json> find(const std::string& identity) const;
    void store(const std::string& identity, const ordered_json& figures) const;
    /// For the stream of a trial while it runs.
    [[nodiscard]] fs::path stream_of(const std::string& identity) const {
        return path(identity, ".stipple");
    }
    void write_table(const std::string& text) const {
        write_text_file(folder_ / "table.csv", true, text);
    }

  private:
    [[nodiscard]] fs::path path(const std::string& identity, std::string_view extension) const;

    fs::path folder_;
};

std::string text_of(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

Results::Results(fs::path folder) : folder_(std::move(folder)) {
    const fs::path version_file = folder_ / "version.txt";
    const std::string own = std::string(version()) + "\n";
    if (fs::exists(version_file)) {
        if (text_of(version_file) != own)
            throw InputError(folder_.string(),
                             fmt::format("holds results of another version of this program, not of "
                                         "{}; give another name, or remove it",
                                         version()));
    } else {
        if (fs::exists(folder_) && (!fs::is_directory(folder_) || !fs::is_empty(folder_)))
            throw InputError(folder_.string(), "is no folder of results; give another name");
        std::error_code error;
        if (fs::create_directory(folder_, error)) sync_to_disk(folder_ / "..");
        if (error) throw InputError(folder_.string(), "cannot be made: " + error.message());
        write_text_file(version_file, true, own);
    }
    std::error_code error;
    if (fs::create_directory(folder_ / "trials", error)) sync_to_disk(folder_);
    if (error) throw DeviceError(folder_.string(), "cannot be written: " + error.message());
    for (const PartialOutput& partial : partial_outputs(folder_ / "trials"))
        if (!partial.running()) fs::remove(partial.path, error);  // of a killed run
}

fs::path Results::path(const std::string& identity, std::string_view extension) const {
    const std::vector<std::uint8_t> bytes(identity.begin(), identity.end());
    return folder_ / "trials" / fmt::format("{:016x}{}", payload_hash(bytes), extension);
}

std::optional<ordered_json> Results::find(const std::string& identity) const {
    const auto json = ordered_json::parse(text_of(path(identity, ".json")), nullptr, false);
    if (!json.is_object() || !json.contains("figures") || !json["figures"].is_object() ||
        json.value("identity", ordered_json()) != identity)
        return std::nullopt;
    return json["figures"];
}

void Results::store(const std::string& identity, const ordered_json& figures) const {
    write_text_file(path(identity, ".json"), true,
                    ordered_json{{"identity", identity}, {"figures", figures}}.dump(2) + "\n");
}

/// The rows of all points so far.
class Table {
  public:
    explicit Table(const Space& space) {
        for (const SpaceAxis& axis : space.axes) names_.push_back(axis.name);
    }
    /// `problem`: why the point has no figures; else empty.
    void add(const SpacePoint& point, const ordered_json& figures, const std::string& problem) {
        rows_.push_back({point, figures, problem});
    }
    /// As RFC 4180 has it, with the names of the columns first.
    [[nodiscard]] std::string csv() const;

  private:
    struct Row {
        SpacePoint point;
        ordered_json figures;
        std::string problem;
    };
    std::vector<std::string> names_;
    std::vector<Row> rows_;
};

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
    return quoted + "\"";
}

std::string csv_field(const ordered_json& value) {
    if (value.is_null()) return {};
    if (value.is_number_float()) return fmt::format("{:.12g}", value.get<double>());
    return value.is_string() ? csv_field(value.get<std::string>()) : value.dump();
}

std::string Table::csv() const {
    constexpr const char* kFigures[] = {
        "slots_per_second",    "limited_by",    "megabits_per_second", "energy_uj_per_slot",
        "light_throughput",    "psnr_db",       "psnr_gamma_db",       "pu21_psnr_db",
        "dynamic_range_stops", "decode_seconds"};
    std::string text;
    for (const std::string& name : names_) text += csv_field(name) + ",";
    for (const char* name : kFigures) text += fmt::format("{},", name);
    text += "problem\n";
    for (const Row& row : rows_) {
        for (const std::string& value : row.point) text += csv_field(value) + ",";
        for (const char* name : kFigures)
            text += (row.figures.contains(name) ? csv_field(row.figures[name]) : "") + ",";
        text += csv_field(row.problem) + "\n";
    }
    return text;
}

/// A run of the command.
class Exploration {
  public:
    Exploration(const ExploreArguments& arguments, const RunOptions& run)
        : space_(read_space(arguments.space)),
          results_(arguments.results),
          table_(space_),
          force_(run.force) {}

    /// Runs all points, until a signal asks to stop.
    void run(Progress& progress);
    [[nodiscard]] const Space& space() const { return space_; }
    [[nodiscard]] ordered_json figures() const {
        return {{"points", space_.size()}, {"run", run_}, {"known", known_}, {"failed", failed_}};
    }
    void write_table() const { results_.write_table(table_.csv()); }

  private:
    void run_point(const SpacePoint& point);
    [[nodiscard]] const TrialLight& light_of(const std::string& footage);

    Space space_;
    Results results_;
    Table table_;
    bool force_;
    std::string footage_;  ///< of light_
    std::optional<TrialLight> light_;
    std::uint64_t run_ = 0;
    std::uint64_t known_ = 0;
    std::uint64_t failed_ = 0;
};

void Exploration::run(Progress& progress) {
    for (std::uint64_t number = 0; number < space_.size() && stop_signal() == 0; ++number) {
        const SpacePoint point = space_.point(number);
        try {
            run_point(point);
        } catch (const Interrupted&) {
            return;
        } catch (const InputError& e) {
            if (stop_signal() != 0) return;  // the signal has cut the input short
            table_.add(point, ordered_json::object(), e.what());
            ++failed_;
        }
        progress.advance();
    }
}

void Exploration::run_point(const SpacePoint& point) {
    const TrialLight& light = light_of(space_.value(point, "footage"));
    const Trial trial = set_up_trial(space_, point, light);
    std::optional<ordered_json> figures;
    if (!force_) figures = results_.find(trial.identity);
    if (figures) {
        ++known_;
    } else {
        figures = run_trial(trial, light, results_.stream_of(trial.identity));
        results_.store(trial.identity, *figures);
        ++run_;
    }
    table_.add(point, *figures, {});
}

const TrialLight& Exploration::light_of(const std::string& footage) {
    if (!light_ || footage != footage_) {
        light_.reset();
        light_ = read_light(space_, footage);
        footage_ = footage;
    }
    return *light_;
}

void explore(const ExploreArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    Exploration exploration(arguments, run);
    const std::uint64_t points = exploration.space().size();
    run.say(fmt::format("{}: {}", arguments.space, counted(points, "point")));
    {
        Progress progress(run, "exploring", static_cast<std::int64_t>(points), "point");
        exploration.run(progress);
    }
    exploration.write_table();
    const ordered_json figures = exploration.figures();
    json.write(figures);
    run.say(fmt::format("{}/table.csv: {} run, {} known before, {} failed", arguments.results,
                        figures["run"].dump(), figures["known"].dump(), figures["failed"].dump()));
}

}  // namespace

void add_explore(Command& app, Action& action) {
    Command command = app.add_command("explore", "A table of many sensors, schedules and decoders");
    const auto arguments = std::make_shared<ExploreArguments>();
    command.add_option("SPACE", arguments->space, "what to try, a TOML file (docs/explore.md)")
        .required()
        .input();
    command
        .add_option("-o,--output", arguments->results,
                    "folder of results; those that it has are kept")
        .type_name("RESULTS")
        .required()
        .output();
    add_threads(command, action.options);
    command.footer(
        "Example:\n"
        "  stipple explore config/spaces/bit_depth.toml -o results\n"
        "A second run does only what is new. A point that cannot be run is a row with the reason.");
    set_action(command, action, arguments, explore);
}

}  // namespace stipple
