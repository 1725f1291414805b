#include "decoder/naive/nearest_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace stipple {
namespace {

constexpr float kTiny = 1e-6F;

struct Neighbour {
    std::size_t pixel;
    float weight;
};

/// Calls body(Neighbour) for the up to 8 pixels around one.
template <typename Body>
void visit_neighbours(FrameShape shape, std::size_t pixel, const Body& body) {
    const auto cols = static_cast<std::size_t>(shape.cols);
    const auto rows = static_cast<std::size_t>(shape.rows);
    const std::size_t row = pixel / cols;
    const std::size_t col = pixel % cols;
    for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, rows - 1); ++r)
        for (std::size_t c = col == 0 ? 0 : col - 1; c <= std::min(col + 1, cols - 1); ++c)
            if (r != row || c != col)
                body(Neighbour{r * cols + c, r == row || c == col ? 2.F : 1.F});
}

/// The pixels of a plane that are to be filled, in an order in which each has known neighbours,
/// and for every pixel how far it is from a sample.
struct FillOrder {
    std::vector<std::size_t> pixels;
    std::vector<std::uint32_t> distance;  ///< 0 sampled, else in pixels; kNever: no sample at all
    static constexpr std::uint32_t kNever = ~std::uint32_t{0};
};

FillOrder fill_order(FrameShape shape, std::span<const std::uint8_t> sampled) {
    FillOrder order{{}, std::vector<std::uint32_t>(shape.pixels(), FillOrder::kNever)};
    std::vector<std::size_t>& pixels = order.pixels;
    for (std::size_t i = 0; i < sampled.size(); ++i)
        if (sampled[i] != 0) order.distance[i] = 0;
    const auto append_neighbours = [&](std::size_t pixel) {
        visit_neighbours(shape, pixel, [&](const Neighbour& n) {
            if (order.distance[n.pixel] != FillOrder::kNever) return;
            order.distance[n.pixel] = order.distance[pixel] + 1;
            pixels.push_back(n.pixel);
        });
    };
    for (std::size_t i = 0; i < sampled.size(); ++i)
        if (sampled[i] != 0) append_neighbours(i);
    for (std::size_t i = 0; i < pixels.size(); ++i) append_neighbours(pixels[i]);
    return order;
}

/// Fills a plane by value(neighbour), of which it takes the mean, and set(pixel, mean).
template <typename Value, typename Set>
void fill(FrameShape shape, const FillOrder& order, const Value& value, const Set& set) {
    for (const std::size_t pixel : order.pixels) {
        float sum = 0;
        float weight = 0;
        visit_neighbours(shape, pixel, [&](const Neighbour& n) {
            if (order.distance[n.pixel] >= order.distance[pixel]) return;
            sum += n.weight * value(n.pixel);
            weight += n.weight;
        });
        set(pixel, sum / weight);
    }
}

/// Sites of the guide between four that are sampled, at pixels that another plane sees, which also
/// sees the pixels two further away: green at the red and blue pixels of a colour filter array.
struct Crossing {
    std::size_t pixel;
    std::size_t plane;  ///< that sees it
};

std::vector<Crossing> crossings(FrameShape shape, std::span<const std::uint8_t> sampled,
                                std::size_t guide) {
    std::vector<Crossing> result;
    const auto cols = static_cast<std::size_t>(shape.cols);
    const auto rows = static_cast<std::size_t>(shape.rows);
    const auto has = [&](std::size_t plane, std::size_t pixel) {
        return sampled[plane * shape.pixels() + pixel] != 0;
    };
    for (std::size_t row = 2; row + 2 < rows; ++row)
        for (std::size_t col = 2; col + 2 < cols; ++col) {
            const std::size_t i = row * cols + col;
            if (has(guide, i) || !has(guide, i - 1) || !has(guide, i + 1) ||
                !has(guide, i - cols) || !has(guide, i + cols))
                continue;
            for (std::size_t p = 0; p < static_cast<std::size_t>(shape.planes); ++p)
                if (has(p, i) && has(p, i - 2) && has(p, i + 2) && has(p, i - 2 * cols) &&
                    has(p, i + 2 * cols))
                    result.push_back({i, p});
        }
    return result;
}

/// Light at a crossing if it continues along one direction, and how little that fits.
struct Continuation {
    float light;
    float misfit;
};

/// `step` pixels lead to the next one in the direction. After Hamilton and Adams (US 5629734).
Continuation along(const float* guide, const float* seen, std::ptrdiff_t step) {
    const float curvature = 2 * seen[0] - seen[-2 * step] - seen[2 * step];
    return {(guide[-step] + guide[step]) / 2 + curvature / 4,
            std::abs(guide[-step] - guide[step]) + std::abs(curvature)};
}

/// Sums over 5 x 5 pixels, those beyond the rim left out.
void box_sum(FrameShape shape, std::vector<float>& x) {
    const auto cols = static_cast<std::size_t>(shape.cols);
    const auto pass = [&](std::size_t count, std::size_t stride, float* line) {
        std::vector<float> from(count);
        for (std::size_t i = 0; i < count; ++i) from[i] = line[i * stride];
        for (std::size_t i = 0; i < count; ++i) {
            float sum = 0;
            for (std::size_t k = i < 2 ? 0 : i - 2; k < std::min(i + 3, count); ++k) sum += from[k];
            line[i * stride] = sum;
        }
    };
    for (std::size_t row = 0; row < static_cast<std::size_t>(shape.rows); ++row)
        pass(cols, 1, &x[row * cols]);
    for (std::size_t col = 0; col < cols; ++col)
        pass(static_cast<std::size_t>(shape.rows), cols, &x[col]);
}

/// Sets the guide at the crossings of a frame: along rows or columns, as the light around does.
void fill_crossings(FrameShape shape, const std::vector<Crossing>& all, std::size_t guide_plane,
                    std::span<float> frame) {
    const std::size_t pixels = shape.pixels();
    float* guide = &frame[guide_plane * pixels];
    std::vector<float> misfit_row(pixels);
    std::vector<float> misfit_col(pixels);
    const auto both = [&](const Crossing& c) {
        const float* seen = &frame[c.plane * pixels + c.pixel];
        return std::pair(along(guide + c.pixel, seen, 1), along(guide + c.pixel, seen, shape.cols));
    };
    for (const Crossing& c : all) {
        const auto [row, col] = both(c);
        misfit_row[c.pixel] = row.misfit;
        misfit_col[c.pixel] = col.misfit;
    }
    box_sum(shape, misfit_row);
    box_sum(shape, misfit_col);
    for (const Crossing& c : all) {
        const auto [row, col] = both(c);
        const float a = misfit_col[c.pixel] * misfit_col[c.pixel] + kTiny;
        const float b = misfit_row[c.pixel] * misfit_row[c.pixel] + kTiny;
        guide[c.pixel] = std::max((a * row.light + b * col.light) / (a + b), 0.0F);
    }
}

/// The plane with the most samples.
std::size_t guide_plane(std::size_t pixels, std::span<const std::uint8_t> sampled) {
    std::size_t guide = 0;
    std::ptrdiff_t max_count = 0;
    for (std::size_t plane = 0; plane * pixels < sampled.size(); ++plane) {
        const auto missing =
            std::ranges::count(sampled.subspan(plane * pixels, pixels), std::uint8_t{0});
        const auto count = static_cast<std::ptrdiff_t>(pixels) - missing;
        if (count > max_count) guide = plane;
        max_count = std::max(max_count, count);
    }
    return guide;
}

}  // namespace

void fill_unsampled(std::span<const std::uint8_t> sampled, FluxVideo& x) {
    const FrameShape shape = x.shape();
    const std::size_t pixels = shape.pixels();
    assert(sampled.size() == shape.sites());
    if (std::ranges::find(sampled, std::uint8_t{0}) == sampled.end()) return;
    const std::size_t guide = guide_plane(pixels, sampled);
    std::vector<FillOrder> orders;
    for (std::size_t site = 0; site < shape.sites(); site += pixels)
        orders.push_back(fill_order(shape, sampled.subspan(site, pixels)));
    const std::vector<Crossing> green = crossings(shape, sampled, guide);
    parallel_for(0, x.slots(), [&](int slot) {
        float* base = &x.frame(slot)[guide * pixels];
        const auto set = [](float& light, float mean) { light = std::max(mean, 0.0F); };
        fill(
            shape, orders[guide], [&](std::size_t i) { return base[i]; },
            [&](std::size_t i, float mean) { set(base[i], mean); });
        fill_crossings(shape, green, guide, x.frame(slot));
        for (std::size_t plane = 0; plane < orders.size(); ++plane) {
            if (plane == guide) continue;
            float* light = &x.frame(slot)[plane * pixels];
            const FillOrder& order = orders[plane];
            if (order.distance[0] == FillOrder::kNever) std::copy_n(base, pixels, light);
            fill(
                shape, order, [&](std::size_t i) { return light[i] - base[i]; },
                [&](std::size_t i, float mean) { set(light[i], base[i] + mean); });
        }
    });
}

}  // namespace stipple
