#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stipple {

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
