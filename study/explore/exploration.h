#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/explore/ranking.h"
#include "study/explore/space.h"
#include "study/explore/trial.h"
#include "study/explore/trial_store.h"

namespace stipple {

struct ExploreOptions {
    std::vector<SpaceAxis> replaced;   ///< axes with other values than in the space
    std::vector<std::string> methods;  ///< for Space::set_methods; empty: those of the space
    std::vector<OwnDecoder> decoders;  ///< that the space may name as methods
    FootageOptions reading = {};       ///< of all footage
    bool force = false;                ///< run trials again that RESULTS has
    int seeds = 1;                     ///< trials of a point: with its seed, the next one ...
    std::optional<Budget> budget;      ///< none: each point with the whole clip
    /// Name of the column by which points are ranked after a rung; empty: by dominance in rate, dB
    /// and energy.
    std::string rank;
    Message::Wording wording = in_cpp;  ///< of parameters in the problems of points
};

/// What is known of a trial.
struct SeedTrial {
    int slots;
    ComparedSlots compared;  ///< of these
    TrialFigures figures;
    std::string address;  ///< in the store
};

/// A row of the table.
struct ExploredPoint {
    bool touched = false;                 ///< false: not reached yet
    int rung = 0;                         ///< whose clip the figures are of, from 1
    int slots = 0;                        ///< of the trials
    ComparedSlots compared;               ///< of these
    std::optional<TrialFigures> figures;  ///< means over the seeds
    std::vector<SeedTrial> trials;        ///< of the seeds, in their order
    Rank rank;                            ///< of rank_points()
    std::string problem;                  ///< why there are no figures, or none of a later rung
};

/// A figure of each of the trials.
[[nodiscard]] std::vector<double> samples_of(const std::vector<SeedTrial>& trials,
                                             double TrialFigures::*figure);

/// Whether intervals of this figure are told: it varies with the noise.
[[nodiscard]] inline bool has_interval(const FigureColumn& column) {
    return column.name.ends_with("_db");
}

/// Numbers of trials.
struct ExploreCounts {
    std::uint64_t run = 0;
    std::uint64_t known = 0;   ///< taken from RESULTS
    std::uint64_t failed = 0;  ///< points that have a problem
};

/// The points of a space, rung by rung, and what is known of them. A trial is a point with one of
/// its seeds; with one seed a point, it has the number of its point. Whoever runs the trials asks
/// for them and hands the outcomes back:
///
///     while (exploration.next_rung())
///         for (std::uint64_t number : exploration.due())
///             if (const Trial* trial = exploration.begin(number))
///                 exploration.put(number, run_trial(*trial, exploration.light(), ...));
class Exploration {
  public:
    /// \throws InputError as parse_space, check_decoder and TrialStore, for two decoders of one
    /// name and for an unknown column to rank by.
    Exploration(const std::filesystem::path& space, const std::filesystem::path& results,
                ExploreOptions options, KeepGoing keep_going);

    /// Begins the first rung, or the next one with the better points; false: there is none.
    bool next_rung();
    /// The trials of the rung.
    [[nodiscard]] const std::vector<std::uint64_t>& due() const { return due_; }
    /// A due trial, valid until the next call; null if it need not run: because RESULTS has it, its
    /// point cannot be set up, or the budget is spent. \throws TrialStopped.
    [[nodiscard]] const Trial* begin(std::uint64_t number);
    /// The trial of the last `begin` that did not return null, and its light.
    [[nodiscard]] const Trial& trial() const { return *trial_; }
    [[nodiscard]] const TrialLight& light() const { return *light_; }
    /// The slots that this trial compares.
    [[nodiscard]] ComparedSlots compared() const { return trial_->compared; }
    /// Of the footage that was read since the last call.
    [[nodiscard]] std::vector<Message> take_warnings() { return std::exchange(warnings_, {}); }
    /// What determines a trial that was begun. Precondition: neither `put` nor `fail` was called.
    [[nodiscard]] const std::string& identity(std::uint64_t number) const {
        return begun_.at(number).identity;
    }
    /// Stores the outcome of a trial that was begun. \throws DeviceError.
    void put(std::uint64_t number, const TrialOutcome& outcome);
    /// The trial could not be run.
    void fail(std::uint64_t number, const Message& problem);
    /// Ranks the points of the last rung that any has reached, those of each footage by themselves:
    /// by psnr_db, or the column of the options. None with one seed a point.
    void rank_points();

    [[nodiscard]] const Space& space() const { return space_; }
    [[nodiscard]] const FootageOptions& reading() const { return options_.reading; }
    [[nodiscard]] int seeds() const { return options_.seeds; }
    /// The values of the point of a trial, with its seed.
    [[nodiscard]] SpacePoint values_of(std::uint64_t number) const;
    /// The values of a trial that others have not, as "random, 8".
    [[nodiscard]] std::string name_of(std::uint64_t number) const;
    /// The last rung that a point has figures of; 0: none.
    [[nodiscard]] int last_rung() const;
    [[nodiscard]] const std::string& space_text() const { return text_; }
    [[nodiscard]] const TrialStore& store() const { return store_; }
    [[nodiscard]] const std::vector<ExploredPoint>& points() const { return points_; }
    [[nodiscard]] ExploreCounts counts() const;
    /// Slots of each rung, from the first one; whole clips only without a budget.
    [[nodiscard]] const std::vector<int>& rungs() const { return rungs_; }
    /// Slots of the present rung.
    [[nodiscard]] int slots() const { return rungs_[rung_ - 1]; }
    /// In the unit of the budget.
    [[nodiscard]] double spent() const { return spent_; }
    /// Trials of all rungs, at most.
    [[nodiscard]] std::uint64_t most_trials() const;
    /// About the work of a trial of the present rung, in a unit that all share: slots, pixels and
    /// the cost of its method. 1 for a point that cannot be set up.
    [[nodiscard]] double work_of(std::uint64_t number) const;
    /// Whether the footage of a point has no more slots than these.
    [[nodiscard]] bool is_whole(std::uint64_t point, int slots) const;
    /// Numbers of the points with figures, best ones first.
    [[nodiscard]] std::vector<std::uint64_t> best_first() const;

  private:
    using Figures = std::map<std::uint64_t, TrialFigures>;  ///< by the number of the point

    struct Begun {
        std::string identity;
        int slots;
        ComparedSlots compared;
    };

    void take(std::uint64_t number, SeedTrial trial);
    void show(std::uint64_t number, int rung, std::vector<SeedTrial> trials);
    void find_whole(std::uint64_t number);
    [[nodiscard]] std::optional<TrialFigures> known_figures(const Trial& trial) const;
    [[nodiscard]] Trial trial_of(std::uint64_t number, int slots);
    [[nodiscard]] ExploredPoint& point_of(std::uint64_t number) {
        return points_[number / seed_count()];
    }
    [[nodiscard]] bool has_whole(const ExploredPoint& point) const {
        return point.rung == static_cast<int>(rungs_.size());
    }
    [[nodiscard]] std::uint64_t seed_count() const {
        return static_cast<std::uint64_t>(options_.seeds);
    }
    [[nodiscard]] std::vector<std::uint64_t> better_half() const;
    [[nodiscard]] std::vector<std::uint64_t> by_rank(const Figures& figures) const;
    void use_light(const std::string& footage);

    ExploreOptions options_;
    std::string text_;
    Space space_;
    TrialStore store_;
    KeepGoing keep_going_;
    std::vector<int> rungs_;
    std::size_t rung_ = 0;  ///< the present one, from 1
    std::vector<std::uint64_t> due_;
    Figures tried_;  ///< the points that have all trials of this rung
    /// The trials of this rung that are known, by point and seed.
    std::map<std::uint64_t, std::map<std::uint64_t, SeedTrial>> known_trials_;
    std::vector<ExploredPoint> points_;
    double spent_ = 0;
    std::uint64_t run_ = 0;
    std::uint64_t known_ = 0;
    std::map<std::string, int> whole_slots_;  ///< of footage that was read to its end
    std::string footage_;                     ///< of light_
    std::optional<TrialLight> light_;
    std::map<int, ComparedSlots> compared_;  ///< of light_, by the number of its slots
    std::vector<Message> warnings_;
    std::optional<Trial> trial_;
    std::map<std::uint64_t, Begun> begun_;  ///< trials that may be running
};

}  // namespace stipple
