#include "study/explore/exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "study/explore/ranking.h"
#include "study/explore/trial.h"

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
    throw InputError(Parameter{"rank"}, fmt::format("\"{}\" is none of {}", name, names));
}

/// The space with what the options change.
Space changed(Space space, const ExploreOptions& options) {
    space.decoders = options.decoders;
    for (const OwnDecoder& decoder : space.decoders) {
        check_decoder(decoder);
        if (std::ranges::count(space.decoders, decoder.name, &OwnDecoder::name) > 1)
            throw InputError(fmt::format("decoder \"{}\"", decoder.name),
                             "has the name of another one; give each its own");
    }
    if (!options.methods.empty()) space.set_methods(options.methods);
    for (const SpaceAxis& axis : options.replaced) space.replace(axis);
    return space;
}

/// The figure so that more is better.
double score(const TrialFigures& figures, const FigureColumn& column) {
    const double value = figures.*column.value;
    return column.better == Better::kMore ? value : -value;
}

SeedTrial known(const Trial& trial, const TrialFigures& figures) {
    return {trial.slots, trial.compared, figures, TrialStore::address_of(trial.identity)};
}

TrialFigures means_of(const std::vector<SeedTrial>& trials) {
    TrialFigures means = trials.front().figures;
    for (const FigureColumn& column : kFigureColumns)
        means.*column.value = mean_of(samples_of(trials, column.value));
    return means;
}

}  // namespace

std::vector<double> samples_of(const std::vector<SeedTrial>& trials, double TrialFigures::*figure) {
    std::vector<double> samples;
    samples.reserve(trials.size());
    for (const SeedTrial& trial : trials) samples.push_back(trial.figures.*figure);
    return samples;
}

Exploration::Exploration(const std::filesystem::path& space, const std::filesystem::path& results,
                         ExploreOptions options, KeepGoing keep_going)
    : options_(checked(std::move(options))),
      text_(file_text(space)),
      space_(changed(parse_space(text_, space.string()), options_)),
      store_(results),
      keep_going_(std::move(keep_going)),
      rungs_(options_.budget ? rungs_of(space_.frames) : std::vector<int>{space_.frames}),
      points_(space_.size()) {}

bool Exploration::next_rung() {
    if (rung_ == rungs_.size()) return false;
    std::vector<std::uint64_t> points(points_.size());
    if (rung_ == 0)
        std::iota(points.begin(), points.end(), std::uint64_t{0});
    else
        points = better_half();
    ++rung_;
    tried_.clear();
    known_trials_.clear();
    due_.clear();
    for (const std::uint64_t point : points)
        for (std::uint64_t seed = 0; seed < seed_count(); ++seed)
            due_.push_back(point * seed_count() + seed);
    return !due_.empty();
}

/// The better ones of the points of this rung that the budget pays for in the next one, in the
/// order of the space.
std::vector<std::uint64_t> Exploration::better_half() const {
    std::vector<std::uint64_t> best = by_rank(tried_);
    const double growth = static_cast<double>(rungs_[rung_]) / rungs_[rung_ - 1];
    std::vector<double> costs;
    costs.reserve(best.size());
    for (const std::uint64_t number : best)
        costs.push_back(options_.seeds * (options_.budget->unit == Budget::Unit::kClips
                                              ? static_cast<double>(rungs_[rung_]) / space_.frames
                                              : growth * tried_.at(number).decode_seconds));
    const double rest = options_.budget->amount - spent_;
    const double share = rest / static_cast<double>(rungs_.size() - rung_);
    best.resize(affordable(costs, (best.size() + 1) / 2, share, rest));
    std::ranges::sort(best);
    return best;
}

std::vector<std::uint64_t> Exploration::by_rank(const Figures& figures) const {
    std::vector<const FigureColumn*> columns{column_of(options_.rank)};
    if (options_.rank.empty()) {
        const bool have_energy = std::ranges::none_of(
            figures, [](const auto& of) { return std::isnan(of.second.energy_uj_per_slot); });
        columns = {column_of("slots_per_second"), column_of("psnr_db"),
                   column_of(have_energy ? "energy_uj_per_slot" : "megabits_per_second")};
    }
    std::vector<Scores> scores;
    std::vector<std::uint64_t> numbers;
    for (const auto& [number, of] : figures) {
        numbers.push_back(number);
        scores.emplace_back();
        for (const FigureColumn* column : columns) scores.back().push_back(score(of, *column));
    }
    std::vector<std::uint64_t> order;
    for (const std::size_t place : ranked(scores)) order.push_back(numbers[place]);
    return order;
}

std::vector<std::uint64_t> Exploration::best_first() const {
    // A point that was decoded in full says more than one that was dropped.
    std::vector<std::uint64_t> order;
    for (auto rung = static_cast<int>(rungs_.size()); rung > 0; --rung) {
        Figures of_rung;
        for (std::uint64_t number = 0; number < points_.size(); ++number)
            if (points_[number].figures && points_[number].rung == rung)
                of_rung[number] = *points_[number].figures;
        std::ranges::copy(by_rank(of_rung), std::back_inserter(order));
    }
    return order;
}

int Exploration::last_rung() const {
    return std::ranges::max_element(points_, {}, &ExploredPoint::rung)->rung;
}

void Exploration::rank_points() {
    if (options_.seeds == 1) return;
    const FigureColumn& column = *column_of(options_.rank.empty() ? "psnr_db" : options_.rank);
    const int rung = last_rung();
    std::map<std::string, std::vector<std::uint64_t>> of_footage;
    for (std::uint64_t number = 0; number < points_.size(); ++number)
        if (points_[number].figures && points_[number].rung == rung)
            of_footage[space_.value(space_.point(number), "footage")].push_back(number);
    for (const auto& [footage, numbers] : of_footage) {
        std::vector<std::vector<double>> samples;
        for (const std::uint64_t number : numbers) {
            samples.push_back(samples_of(points_[number].trials, column.value));
            for (double& sample : samples.back()) sample *= column.better == Better::kMore ? 1 : -1;
        }
        const std::vector<Rank> ranks = tied_ranks(samples);
        for (std::size_t i = 0; i < numbers.size(); ++i) points_[numbers[i]].rank = ranks[i];
    }
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

bool Exploration::is_whole(std::uint64_t point, int slots) const {
    const std::string footage = space_.value(space_.point(point), "footage");
    const auto whole = whole_slots_.find(footage);
    return is_scene(footage) || (whole != whole_slots_.end() && whole->second <= slots);
}

SpacePoint Exploration::values_of(std::uint64_t number) const {
    SpacePoint values = space_.point(number / seed_count());
    std::string& text = values[space_.axis("seed")];
    // A text that is no seed stays what it is, for the message of the trial.
    if (const auto seed = parsed_number<std::uint64_t>(text))
        text = std::to_string(*seed + number % seed_count());
    return values;
}

std::string Exploration::name_of(std::uint64_t number) const {
    const SpacePoint values = values_of(number);
    std::string name;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SpaceAxis& axis = space_.axes[i];
        const bool is_seed = axis.name == "seed";
        const bool varies = axis.values.size() > 1 || (is_seed && options_.seeds > 1);
        if (!varies || values[i].empty()) continue;
        name += (name.empty() ? "" : ", ") + (is_seed ? "seed " + values[i] : values[i]);
    }
    return name;
}

/// \throws InputError, TrialStopped.
Trial Exploration::trial_of(std::uint64_t number, int slots) {
    const SpacePoint values = values_of(number);
    use_light(space_.value(values, "footage"));
    if (!compared_.contains(slots))
        compared_[slots] = compared_slots(space_, *light_, slots, keep_going_);
    return set_up_trial(space_, values, *light_, slots, compared_[slots]);
}

/// Those of RESULTS, unless nobody knows whether its decoder has stayed the same.
std::optional<TrialFigures> Exploration::known_figures(const Trial& trial) const {
    if (trial.own && trial.own->version.empty()) return std::nullopt;
    return store_.find(trial.identity);
}

/// Shows the figures of the whole clip if RESULTS has them for all seeds of the point of a trial.
void Exploration::find_whole(std::uint64_t number) {
    std::vector<SeedTrial> trials;
    try {
        for (std::uint64_t seed = 0; seed < seed_count(); ++seed) {
            const Trial trial = trial_of(number + seed, space_.frames);
            const auto figures = known_figures(trial);
            if (!figures) return;
            trials.push_back(known(trial, *figures));
        }
    } catch (const InputError&) {
        return;  // which the trial of the rung tells
    }
    show(number, static_cast<int>(rungs_.size()), std::move(trials));
}

const Trial* Exploration::begin(std::uint64_t number) {
    ExploredPoint& point = point_of(number);
    if (!point.problem.empty()) return nullptr;  // of another seed
    if (rung_ == 1 && rungs_.size() > 1 && number % seed_count() == 0) find_whole(number);
    if (options_.budget && spent_ >= options_.budget->amount) {
        if (!has_whole(point)) fail(number, "was not tried: the budget was spent");
        return nullptr;
    }
    try {
        trial_.reset();
        trial_ = trial_of(number, slots());
    } catch (const InputError& e) {
        if (!keep_going_()) throw TrialStopped();  // which has cut the input short
        fail(number, e.message());
        return nullptr;
    }
    if (!point.figures) {
        point.slots = trial_->slots;
        point.compared = trial_->compared;
    }
    if (!options_.force)
        if (const auto figures = known_figures(*trial_)) {
            ++known_;
            take(number, known(*trial_, *figures));
            return nullptr;
        }
    begun_[number] = {trial_->identity, trial_->slots, trial_->compared};
    return &*trial_;
}

void Exploration::take(std::uint64_t number, SeedTrial trial) {
    const bool counts_clips = options_.budget && options_.budget->unit == Budget::Unit::kClips;
    spent_ +=
        counts_clips ? static_cast<double>(slots()) / space_.frames : trial.figures.decode_seconds;
    const std::uint64_t point = number / seed_count();
    auto& by_seed = known_trials_[point];
    by_seed[number % seed_count()] = std::move(trial);
    if (by_seed.size() < seed_count()) return;
    std::vector<SeedTrial> trials;
    for (auto& [seed, of_seed] : by_seed) trials.push_back(std::move(of_seed));
    known_trials_.erase(point);
    tried_[point] = means_of(trials);
    show(number, static_cast<int>(rung_), std::move(trials));
}

/// Figures of a shorter clip never take the place of those of a longer one.
void Exploration::show(std::uint64_t number, int rung, std::vector<SeedTrial> trials) {
    ExploredPoint& point = point_of(number);
    if (point.rung > rung) return;
    point.touched = true;
    point.rung = rung;
    point.slots = trials.front().slots;
    point.compared = trials.front().compared;
    point.figures = means_of(trials);
    point.trials = std::move(trials);
}

void Exploration::put(std::uint64_t number, const TrialOutcome& outcome) {
    const Begun begun = std::move(begun_.at(number));
    begun_.erase(number);
    store_.store(begun.identity, outcome);
    ++run_;
    take(number,
         {begun.slots, begun.compared, outcome.figures, TrialStore::address_of(begun.identity)});
}

void Exploration::fail(std::uint64_t number, const Message& problem) {
    begun_.erase(number);
    point_of(number).touched = true;
    point_of(number).problem = problem.text(options_.wording);
}

ExploreCounts Exploration::counts() const {
    ExploreCounts counts{run_, known_, 0};
    for (const ExploredPoint& point : points_)
        if (!point.problem.empty()) ++counts.failed;
    return counts;
}

double Exploration::work_of(std::uint64_t number) const {
    constexpr double kEmulation = 1;  // of a voxel, with what else is not the method's
    try {
        const SpacePoint point = space_.point(number / seed_count());
        const PointView view = view_of(space_, point);
        const DecodeMethod method = decode_method_from_name(space_.value(point, "method"));
        return slots() * view.rows / (view.binning * view.binning) *
               (named(method).voxel_us + kEmulation);
    } catch (const InputError&) {
        return 1;
    }
}

std::uint64_t Exploration::most_trials() const {
    std::uint64_t trials = 0;
    std::uint64_t points = points_.size();
    for (std::size_t rung = 0; rung < rungs_.size(); ++rung) {
        trials += points * seed_count();
        points = (points + 1) / 2;
    }
    return trials;
}

}  // namespace stipple
