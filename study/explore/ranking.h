#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// Where the mean of a random figure lies.
struct MeanInterval {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double low = mean;
    double high = mean;

    /// Whether the mean may be 0. An interval that is not known may hold any value.
    [[nodiscard]] bool may_be_zero() const { return !(low > 0) && !(high < 0); }
};

/// The t below which a variable of Student's distribution lies with a probability of 97.5 %.
/// Precondition: degrees > 0.
[[nodiscard]] double student_t_975(int degrees);

/// Equal samples have themselves as mean, to the last bit. Precondition: there are samples.
[[nodiscard]] double mean_of(std::span<const double> samples);

/// The interval that holds the mean of a normal variable with a probability of 95 %, by Student's
/// t: mean +- t s / sqrt(n). NaN as its ends: of less than two samples, or of some that are
/// infinite; equal samples are their own interval. Precondition: there are samples.
/// `t` is student_t_975 of one less than their number.
[[nodiscard]] MeanInterval mean_interval(std::span<const double> samples, double t);
[[nodiscard]] MeanInterval mean_interval(std::span<const double> samples);

/// A rank, from 1. Ranks that are tied cannot be told apart.
struct Rank {
    int place = 0;
    bool is_tied = false;

    bool operator==(const Rank&) const = default;
};

/// "1", tied "1="; empty without a rank.
[[nodiscard]] std::string text_of(Rank rank);

/// Ranks of points by the means of their samples, more being better. Sample i of each point is of
/// the same noise and footage. The best point shares its rank with all whose mean_interval of the
/// differences holds 0, whatever lies between them; the best one of the others has its place by the
/// mean, and so on. Precondition: all have equally many samples, two
/// at least.
[[nodiscard]] std::vector<Rank> tied_ranks(std::span<const std::vector<double>> points);

/// Scores of a point by some measures, of which more is better; NaN is worse than all.
using Scores = std::vector<double>;

/// For each point its layer: 0 where no other one is as good by all measures and better by one, 1
/// where that holds without those of layer 0, and so on. Precondition: all have equally many
/// scores. Zhang, Tian, Cheng and Jin, "An efficient approach to nondominated sorting", 2015.
[[nodiscard]] std::vector<std::size_t> layers_of(std::span<const Scores> points);

/// Indices of the points, by layer. Within a layer first the ends of its first measure, then the
/// middles of the gaps that are left: so the first ones, however many, are spread over it. Equal
/// points in their order.
[[nodiscard]] std::vector<std::size_t> ranked(std::span<const Scores> points);

/// What decoding may cost in all.
struct Budget {
    enum class Unit : std::uint8_t {
        kSeconds,  ///< measured time of decoding
        kClips,    ///< decoded clips, a shorter one as its fraction
    };
    double amount = 0;
    Unit unit = Unit::kClips;
};

/// "90s", "10m", "2h" or a number of clips; nothing for other texts and for 0 or less.
[[nodiscard]] std::optional<Budget> parse_budget(const std::string& text);

/// Slots of the rungs of a clip: the whole clip, before that a half, before that a quarter; none of
/// fewer than kMinRungSlots slots.
[[nodiscard]] std::vector<int> rungs_of(int slots);
inline constexpr int kMinRungSlots = 12;

/// How many of the points, best ones first, go on: at most `most`; as many as the `share` of the
/// rung pays for at the expected `costs`, but one if `rest` pays for it.
[[nodiscard]] std::size_t affordable(std::span<const double> costs, std::size_t most, double share,
                                     double rest);

}  // namespace stipple
