#include "explore/ranking.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>

namespace stipple {
namespace {

double comparable(double score) {
    return std::isnan(score) ? -std::numeric_limits<double>::infinity() : score;
}

bool dominates(const Scores& a, const Scores& b) {
    bool is_better = false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = comparable(a[i]);
        const double y = comparable(b[i]);
        if (x < y) return false;
        is_better |= x > y;
    }
    return is_better;
}

/// By falling scores, the first measure first; equal points in their order.
std::vector<std::size_t> falling(std::span<const Scores> points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return std::ranges::lexicographical_compare(
            points[b], points[a], [](double x, double y) { return comparable(x) < comparable(y); });
    });
    return order;
}

/// 0, count - 1, then the middles of the gaps, breadth first.
std::vector<std::size_t> spread(std::size_t count) {
    std::vector<std::size_t> order;
    if (count > 0) order.push_back(0);
    if (count > 1) order.push_back(count - 1);
    std::deque<std::pair<std::size_t, std::size_t>> gaps{{0, count == 0 ? 0 : count - 1}};
    while (!gaps.empty()) {
        const auto [low, high] = gaps.front();
        gaps.pop_front();
        if (high - low < 2) continue;
        const std::size_t middle = low + (high - low) / 2;
        order.push_back(middle);
        gaps.emplace_back(low, middle);
        gaps.emplace_back(middle, high);
    }
    return order;
}

/// The points of each layer, by falling scores: none can dominate one before it.
std::vector<std::vector<std::size_t>> fronts_of(std::span<const Scores> points) {
    std::vector<std::vector<std::size_t>> fronts;
    for (const std::size_t point : falling(points)) {
        const auto front = std::ranges::find_if(fronts, [&](const auto& members) {
            // The last ones are the likeliest to dominate.
            return std::none_of(members.rbegin(), members.rend(), [&](std::size_t member) {
                return dominates(points[member], points[point]);
            });
        });
        if (front == fronts.end())
            fronts.push_back({point});
        else
            front->push_back(point);
    }
    return fronts;
}

}  // namespace

std::vector<std::size_t> layers_of(std::span<const Scores> points) {
    std::vector<std::size_t> layers(points.size());
    const auto fronts = fronts_of(points);
    for (std::size_t layer = 0; layer < fronts.size(); ++layer)
        for (const std::size_t point : fronts[layer]) layers[point] = layer;
    return layers;
}

std::vector<std::size_t> ranked(std::span<const Scores> points) {
    std::vector<std::size_t> order;
    order.reserve(points.size());
    for (const auto& front : fronts_of(points))
        for (const std::size_t place : spread(front.size())) order.push_back(front[place]);
    return order;
}

}  // namespace stipple
