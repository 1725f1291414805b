#include "readout/schedules/hardware_tiled_parts.h"

#include <algorithm>
#include <numeric>

namespace stipple {
namespace {

constexpr std::size_t kMaxListed = 6;      ///< lengths whose (n - 1)! cyclic orders are all listed
constexpr std::size_t kDrawnOrders = 120;  ///< of more lengths

/// Small where long and short exposures alternate.
int sum_of_products(const std::vector<int>& order) {
    int sum = order.back() * order.front();
    for (std::size_t i = 1; i < order.size(); ++i) sum += order[i - 1] * order[i];
    return sum;
}

/// Cyclic orders of `lengths`, each written from its first length on.
std::vector<std::vector<int>> list_orders(std::vector<int> lengths, Draws& draws) {
    std::ranges::sort(lengths);
    std::vector<std::vector<int>> orders;
    if (lengths.size() <= kMaxListed) {
        do {
            orders.push_back(lengths);
        } while (std::next_permutation(lengths.begin() + 1, lengths.end()));
        return orders;
    }
    for (std::size_t drawn = 0; drawn < kDrawnOrders; ++drawn) {
        for (std::size_t i = lengths.size() - 1; i > 1; --i)
            std::swap(lengths[i], lengths[1 + draws.below(i)]);
        orders.push_back(lengths);
    }
    return orders;
}

/// Slots that [0, length) and [shift, shift + other) share on a circle of `period` slots.
int overlap(int length, int shift, int other, int period) {
    int shared = 0;
    for (const int turn : {-period, 0, period}) {
        const int begin = std::max(0, shift + turn);
        const int end = std::min(length, shift + other + turn);
        shared += std::max(0, end - begin);
    }
    return shared;
}

/// `overlap` of a code that begins in slot 0 and one that begins in slot `shift`.
double overlap_of(const std::vector<int>& a, const std::vector<int>& b, int shift, int period) {
    double sum = 0;
    int begin_a = 0;
    for (const int length_a : a) {
        int begin_b = shift;
        for (const int length_b : b) {
            const int apart = ((begin_b - begin_a) % period + period) % period;
            const double shared = overlap(length_a, apart, length_b, period);
            sum += shared * shared / (1.0 * length_a * length_b);
            begin_b += length_b;
        }
        begin_a += length_a;
    }
    return sum;
}

}  // namespace

CodeSet::CodeSet(std::span<const int> exposure_slots, Draws& draws)
    : lengths_(exposure_slots.size()),
      period_(std::accumulate(exposure_slots.begin(), exposure_slots.end(), 0)) {
    choose_orders(exposure_slots, draws);
    list_due();
    tabulate_overlaps();
}

void CodeSet::choose_orders(std::span<const int> exposure_slots, Draws& draws) {
    orders_ = list_orders({exposure_slots.begin(), exposure_slots.end()}, draws);
    std::ranges::stable_sort(orders_, {}, sum_of_products);
    if (orders_.size() > kMaxOrders) orders_.resize(kMaxOrders);
    best_orders_ = static_cast<int>(
        std::ranges::count(orders_, sum_of_products(orders_.front()), sum_of_products));
}

void CodeSet::list_due() {
    for (const auto& order : orders_) {
        std::vector<int> due(order.size());
        std::partial_sum(order.begin(), order.end(), due.begin());
        for (int& slot : due) --slot;
        due_.push_back(std::move(due));
    }
}

void CodeSet::tabulate_overlaps() {
    overlaps_.reserve(orders_.size() * orders_.size() * static_cast<std::size_t>(period_));
    for (const auto& a : orders_)
        for (const auto& b : orders_)
            for (int shift = 0; shift < period_; ++shift) {
                const double overlap = overlap_of(a, b, shift, period_);
                overlaps_.push_back(static_cast<std::int32_t>(overlap * kUnit + 0.5));
            }
}

void CodeSet::append(GroupCode code, std::vector<Exposure>& exposures) const {
    const auto period = static_cast<std::uint32_t>(period_);
    std::uint32_t slot = code.first_slot;
    for (const int length : orders_[code.order]) {
        exposures.push_back({slot % period, open_without_gap(length)});
        slot += static_cast<std::uint32_t>(length);
    }
}

}  // namespace stipple
