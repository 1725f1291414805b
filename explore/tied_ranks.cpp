#include "explore/ranking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>

#include "explore/mean_interval.h"

namespace stipple {
namespace {

bool may_be_equal(const std::vector<double>& a, const std::vector<double>& b, double t) {
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        differences[i] = a[i] == b[i] ? 0 : a[i] - b[i];  // also of two infinite ones
    return mean_interval(differences, t).may_be_zero();
}

/// Indices of the points by falling means.
std::vector<std::size_t> order_of(std::span<const std::vector<double>> points) {
    std::vector<double> means;
    for (const std::vector<double>& samples : points) {
        const double mean = mean_of(samples);
        means.push_back(std::isnan(mean) ? -std::numeric_limits<double>::infinity() : mean);
    }
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return means[i]; });
    return order;
}

}  // namespace

std::string text_of(Rank rank) {
    return rank.place == 0 ? "" : std::to_string(rank.place) + (rank.is_tied ? "=" : "");
}

std::vector<Rank> tied_ranks(std::span<const std::vector<double>> points) {
    std::vector<Rank> ranks(points.size());
    if (points.empty()) return ranks;
    const double t = student_t_975(static_cast<int>(points.front().size()) - 1);
    const std::vector<std::size_t> order = order_of(points);
    for (std::size_t first = 0; first < order.size(); ++first) {
        Rank& rank = ranks[order[first]];
        if (rank.place != 0) continue;
        rank.place = static_cast<int>(first) + 1;
        for (std::size_t i = first + 1; i < order.size(); ++i) {
            Rank& other = ranks[order[i]];
            if (other.place != 0 || !may_be_equal(points[order[first]], points[order[i]], t))
                continue;
            other = {rank.place, true};
            rank.is_tied = true;
        }
    }
    return ranks;
}

}  // namespace stipple
