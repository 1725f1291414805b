#include "decoder/unsampled_sites.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

#include "core/parallel.h"

namespace stipple {
namespace {

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

/// The plane with the most samples.
std::size_t guide_plane(std::size_t pixels, std::span<const std::uint8_t> sampled) {
    std::size_t guide = 0;
    std::ptrdiff_t most = 0;
    for (std::size_t plane = 0; plane * pixels < sampled.size(); ++plane) {
        const auto missing =
            std::ranges::count(sampled.subspan(plane * pixels, pixels), std::uint8_t{0});
        const auto count = static_cast<std::ptrdiff_t>(pixels) - missing;
        if (count > most) guide = plane;
        most = std::max(most, count);
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
    parallel_for(0, x.slots(), [&](int slot) {
        float* base = &x.frame(slot)[guide * pixels];
        const auto set = [](float& light, float mean) { light = std::max(mean, 0.0F); };
        fill(
            shape, orders[guide], [&](std::size_t i) { return base[i]; },
            [&](std::size_t i, float mean) { set(base[i], mean); });
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
