#include "study/explore/ranking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

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

/// The probability of -t .. t. Source: Abramowitz and Stegun, 26.7.3 and 26.7.4.
double probability_within(double t, int degrees) {
    const double angle = std::atan(t / std::sqrt(degrees));
    const double cos2 = std::cos(angle) * std::cos(angle);
    const bool is_odd = degrees % 2 == 1;
    double term = is_odd ? std::cos(angle) : 1, sum = degrees == 1 ? 0 : term;
    for (int i = is_odd ? 3 : 2; i < degrees - 1; i += 2) {
        term *= cos2 * (i - 1) / i;
        sum += term;
    }
    sum *= std::sin(angle);
    return is_odd ? (angle + sum) * 2 / std::numbers::pi : sum;
}

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

double student_t_975(int degrees) {
    double low = 0, high = 16;  // 12.7 with one degree of freedom, less with more
    while (true) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) return middle;
        (probability_within(middle, degrees) < 0.95 ? low : high) = middle;
    }
}

double mean_of(std::span<const double> samples) {
    if (std::ranges::all_of(samples, [&](double x) { return x == samples.front(); }))
        return samples.front();
    return std::accumulate(samples.begin(), samples.end(), 0.0) /
           static_cast<double>(samples.size());
}

MeanInterval mean_interval(std::span<const double> samples, double t) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const double mean = mean_of(samples);
    if (samples.size() < 2) return {mean, kNone, kNone};
    double squares = 0;
    for (const double x : samples) squares += x == mean ? 0 : (x - mean) * (x - mean);
    if (!std::isfinite(squares)) return {mean, kNone, kNone};
    const auto count = static_cast<double>(samples.size());
    const double half = squares == 0 ? 0 : t * std::sqrt(squares / (count - 1) / count);
    return {mean, mean - half, mean + half};
}

MeanInterval mean_interval(std::span<const double> samples) {
    const auto degrees = static_cast<int>(samples.size()) - 1;
    return mean_interval(samples, degrees > 0 ? student_t_975(degrees) : 0);
}

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
