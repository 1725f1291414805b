#include "explore/exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/input_file.h"
#include "explore/compared_slots.h"
#include "explore/ranking.h"

namespace stipple {
namespace {

std::string file_text(const std::filesystem::path& file) {
    const auto bytes = read_file(file);
    return {bytes.begin(), bytes.end()};
}

/// Null if there is none of this name.
const FigureColumn* column_of(std::string_view name) {
    const auto* const found = std::ranges::find(kFigureColumns, name, &FigureColumn::name);
    return found == kFigureColumns.end() ? nullptr : found;
}

ExploreOptions checked(ExploreOptions options) {
    const std::string& name = options.rank;
    if (name.empty() || column_of(name) != nullptr) return options;
    std::string names;
    for (const FigureColumn& column : kFigureColumns)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", column.name);
    throw InputError("--rank", fmt::format("\"{}\" is none of {}", name, names));
}

Space replaced(Space space, const std::vector<SpaceAxis>& axes) {
    for (const SpaceAxis& axis : axes) space.replace(axis);
    return space;
}

/// The figure so that more is better.
double score(const TrialFigures& figures, const FigureColumn& column) {
    const double value = figures.*column.value;
    return column.better == Better::kMore ? value : -value;
}

}  // namespace

Exploration::Exploration(const std::filesystem::path& space, const std::filesystem::path& results,
                         ExploreOptions options, KeepGoing keep_going)
    : options_(checked(std::move(options))),
      text_(file_text(space)),
      space_(replaced(parse_space(text_, space.string()), options_.replaced)),
      store_(results),
      keep_going_(std::move(keep_going)),
      rungs_(options_.budget ? rungs_of(space_.frames) : std::vector<int>{space_.frames}),
      points_(space_.size()) {}

bool Exploration::next_rung() {
    if (rung_ == rungs_.size()) return false;
    if (rung_ == 0) {
        due_.resize(points_.size());
        std::iota(due_.begin(), due_.end(), std::uint64_t{0});
    } else {
        due_ = better_half();
    }
    ++rung_;
    return !due_.empty();
}

/// The better ones of the points of this rung that the budget pays for in the next one, in the
/// order of the space.
std::vector<std::uint64_t> Exploration::better_half() const {
    std::vector<std::uint64_t> tried;
    for (const std::uint64_t number : due_)
        if (points_[number].rung == static_cast<int>(rung_) && points_[number].figures)
            tried.push_back(number);
    std::vector<std::uint64_t> best = by_rank(tried);
    const double growth = static_cast<double>(rungs_[rung_]) / rungs_[rung_ - 1];
    std::vector<double> costs;
    costs.reserve(best.size());
    for (const std::uint64_t number : best)
        costs.push_back(options_.budget->unit == Budget::Unit::kClips
                            ? static_cast<double>(rungs_[rung_]) / space_.frames
                            : growth * points_[number].figures->decode_seconds);
    const double rest = options_.budget->amount - spent_;
    const double share = rest / static_cast<double>(rungs_.size() - rung_);
    best.resize(affordable(costs, (best.size() + 1) / 2, share, rest));
    std::ranges::sort(best);
    return best;
}

std::vector<std::uint64_t> Exploration::by_rank(const std::vector<std::uint64_t>& numbers) const {
    std::vector<const FigureColumn*> columns{column_of(options_.rank)};
    if (options_.rank.empty()) {
        const bool have_energy = std::ranges::none_of(numbers, [&](std::uint64_t number) {
            return std::isnan(points_[number].figures->energy_uj_per_slot);
        });
        columns = {column_of("slots_per_second"), column_of("psnr_db"),
                   column_of(have_energy ? "energy_uj_per_slot" : "megabits_per_second")};
    }
    std::vector<Scores> scores;
    for (const std::uint64_t number : numbers) {
        scores.emplace_back();
        for (const FigureColumn* column : columns)
            scores.back().push_back(score(*points_[number].figures, *column));
    }
    std::vector<std::uint64_t> order;
    for (const std::size_t place : ranked(scores)) order.push_back(numbers[place]);
    return order;
}

std::vector<std::uint64_t> Exploration::best_first() const {
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t number = 0; number < points_.size(); ++number)
        if (points_[number].figures) numbers.push_back(number);
    // A point that was decoded in full says more than one that was dropped.
    std::vector<std::uint64_t> order;
    for (auto rung = static_cast<int>(rungs_.size()); rung > 0; --rung) {
        std::vector<std::uint64_t> of_rung;
        std::ranges::copy_if(numbers, std::back_inserter(of_rung),
                             [&](std::uint64_t number) { return points_[number].rung == rung; });
        std::ranges::copy(by_rank(of_rung), std::back_inserter(order));
    }
    return order;
}

void Exploration::use_light(const std::string& footage) {
    if (light_ && footage == footage_) return;
    light_.reset();
    light_ = read_light(space_, footage, options_.reading, keep_going_);
    footage_ = footage;
    compared_.clear();
    std::ranges::move(light_->warnings, std::back_inserter(warnings_));
    if (light_->is_whole) whole_slots_[footage] = light_->video.slots();
}

bool Exploration::is_whole(std::uint64_t number, int slots) const {
    const std::string footage = space_.value(space_.point(number), "footage");
    const auto whole = whole_slots_.find(footage);
    return is_scene(footage) || (whole != whole_slots_.end() && whole->second <= slots);
}

const Trial* Exploration::begin(std::uint64_t number) {
    ExploredPoint& point = points_[number];
    if (options_.budget && spent_ >= options_.budget->amount) {
        point.touched = true;
        point.problem = "was not tried: the budget was spent";
        return nullptr;
    }
    const SpacePoint values = space_.point(number);
    try {
        use_light(space_.value(values, "footage"));
        if (!compared_.contains(slots()))
            compared_[slots()] = compared_slots(space_, *light_, slots(), keep_going_);
        trial_.reset();
        trial_ = set_up_trial(space_, values, *light_, slots(), compared_[slots()]);
        point.slots = trial_->slots;
        point.compared = trial_->compared;
    } catch (const InputError& e) {
        if (!keep_going_()) throw TrialStopped();  // which has cut the input short
        fail(number, e.what());
        return nullptr;
    }
    if (!options_.force)
        if (const auto figures = store_.find(trial_->identity)) {
            ++known_;
            take(number, trial_->identity, *figures);
            return nullptr;
        }
    begun_[number] = trial_->identity;
    return &*trial_;
}

void Exploration::take(std::uint64_t number, const std::string& identity,
                       const TrialFigures& figures) {
    ExploredPoint& point = points_[number];
    point.touched = true;
    point.rung = static_cast<int>(rung_);
    point.figures = figures;
    point.address = TrialStore::address_of(identity);
    point.problem.clear();
    const bool counts_clips = options_.budget && options_.budget->unit == Budget::Unit::kClips;
    spent_ += counts_clips ? static_cast<double>(slots()) / space_.frames : figures.decode_seconds;
}

void Exploration::put(std::uint64_t number, const TrialOutcome& outcome) {
    const std::string identity = std::move(begun_.at(number));
    begun_.erase(number);
    store_.store(identity, outcome);
    ++run_;
    take(number, identity, outcome.figures);
}

void Exploration::fail(std::uint64_t number, const std::string& problem) {
    begun_.erase(number);
    points_[number].touched = true;
    points_[number].problem = problem;
}

ExploreCounts Exploration::counts() const {
    ExploreCounts counts{run_, known_, 0};
    for (const ExploredPoint& point : points_)
        if (!point.problem.empty()) ++counts.failed;
    return counts;
}

std::uint64_t Exploration::most_trials() const {
    std::uint64_t trials = 0;
    std::uint64_t points = points_.size();
    for (std::size_t rung = 0; rung < rungs_.size(); ++rung) {
        trials += points;
        points = (points + 1) / 2;
    }
    return trials;
}

}  // namespace stipple
