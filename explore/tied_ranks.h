#pragma once

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

}  // namespace stipple
