#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/budget.h"
#include "explore/space.h"
#include "explore/trial.h"
#include "explore/trial_store.h"

namespace stipple {

struct ExploreOptions {
    std::vector<SpaceAxis> replaced;  ///< axes with other values than in the space
    FootageOptions reading = {};      ///< of all footage
    bool force = false;               ///< run trials again that RESULTS has
    std::optional<Budget> budget;     ///< none: each point with the whole clip
    /// Name of the column by which points are ranked after a rung; empty: by dominance in rate, dB
    /// and energy.
    std::string rank;
};

/// A row of the table.
struct ExploredPoint {
    bool touched = false;    ///< false: not reached yet
    int rung = 0;            ///< the last one that it was tried in, from 1
    int slots = 0;           ///< of the last trial
    ComparedSlots compared;  ///< of these
    std::optional<TrialFigures> figures;
    std::string problem;  ///< why there are none, or none of a later rung
    std::string address;  ///< of the trial of `figures` in the store
};

/// Numbers of trials.
struct ExploreCounts {
    std::uint64_t run = 0;
    std::uint64_t known = 0;   ///< taken from RESULTS
    std::uint64_t failed = 0;  ///< points that have a problem
};

/// The points of a space, rung by rung, and what is known of them. Whoever runs the trials asks for
/// them and hands the outcomes back:
///
///     while (exploration.next_rung())
///         for (std::uint64_t number : exploration.due())
///             if (const Trial* trial = exploration.begin(number))
///                 exploration.put(number, run_trial(*trial, exploration.light(), ...));
class Exploration {
  public:
    /// \throws InputError as parse_space and TrialStore, and for an unknown column to rank by.
    Exploration(const std::filesystem::path& space, const std::filesystem::path& results,
                ExploreOptions options, KeepGoing keep_going);

    /// Begins the first rung, or the next one with the better points; false: there is none.
    bool next_rung();
    /// The points of the rung.
    [[nodiscard]] const std::vector<std::uint64_t>& due() const { return due_; }
    /// The trial of a due point in this rung, valid until the next call; null if it need not run:
    /// because RESULTS has it, it cannot be set up, or the budget is spent. \throws TrialStopped.
    [[nodiscard]] const Trial* begin(std::uint64_t number);
    /// The trial of the last `begin` that did not return null, and its light.
    [[nodiscard]] const Trial& trial() const { return *trial_; }
    [[nodiscard]] const TrialLight& light() const { return *light_; }
    /// The slots that this trial compares.
    [[nodiscard]] ComparedSlots compared() const { return trial_->compared; }
    /// Of the footage that was read since the last call.
    [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
    /// What determines a trial that was begun. Precondition: neither `put` nor `fail` was called.
    [[nodiscard]] const std::string& identity(std::uint64_t number) const {
        return begun_.at(number);
    }
    /// Stores the outcome of a trial that was begun. \throws DeviceError.
    void put(std::uint64_t number, const TrialOutcome& outcome);
    /// The trial could not be run.
    void fail(std::uint64_t number, const std::string& problem);

    [[nodiscard]] const Space& space() const { return space_; }
    [[nodiscard]] const FootageOptions& reading() const { return options_.reading; }
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
    /// Whether the footage of a point has no more slots than these.
    [[nodiscard]] bool is_whole(std::uint64_t number, int slots) const;
    /// Numbers of the points with figures, best ones first.
    [[nodiscard]] std::vector<std::uint64_t> best_first() const;

  private:
    void take(std::uint64_t number, const std::string& identity, const TrialFigures& figures);
    [[nodiscard]] std::vector<std::uint64_t> better_half() const;
    [[nodiscard]] std::vector<std::uint64_t> by_rank(
        const std::vector<std::uint64_t>& numbers) const;
    void use_light(const std::string& footage);

    ExploreOptions options_;
    std::string text_;
    Space space_;
    TrialStore store_;
    KeepGoing keep_going_;
    std::vector<int> rungs_;
    std::size_t rung_ = 0;  ///< the present one, from 1
    std::vector<std::uint64_t> due_;
    std::vector<ExploredPoint> points_;
    double spent_ = 0;
    std::uint64_t run_ = 0;
    std::uint64_t known_ = 0;
    std::map<std::string, int> whole_slots_;  ///< of footage that was read to its end
    std::string footage_;                     ///< of light_
    std::optional<TrialLight> light_;
    std::map<int, ComparedSlots> compared_;  ///< of light_, by the number of its slots
    std::vector<std::string> warnings_;
    std::optional<Trial> trial_;
    std::map<std::uint64_t, std::string> begun_;  ///< identities of trials that may be running
};

}  // namespace stipple
