#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace stipple {

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

}  // namespace stipple
