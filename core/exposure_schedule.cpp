#include "core/exposure_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "core/index.h"
#include "core/philox.h"

namespace stipple {
namespace {

constexpr char kWhere[] = "exposure schedule";

/// The most of a pixel's exposures whose spans cover one slot of the period. `under_way` holds a
/// zero for each slot, before and after.
int max_at_once(std::span<const Exposure> exposures, std::span<int> under_way) {
    const auto slot = [&](const Exposure& e, int i) -> int& {
        return under_way[(e.first_slot + index(i)) % under_way.size()];
    };
    int max_open = 0;
    for (const Exposure& e : exposures)
        for (int i = 0; i < e.span_slots(); ++i) max_open = std::max(max_open, ++slot(e, i));
    for (const Exposure& e : exposures)
        for (int i = 0; i < e.span_slots(); ++i) slot(e, i) = 0;
    return max_open;
}

/// Bits of `stores_` for one pixel: exposures in the order in which they begin, over some periods,
/// each take the first free of two stores. As exposures last no longer than a period, the choice
/// repeats from the second period on, every period or every second one.
void choose_stores(std::span<const Exposure> exposures, int period_slots,
                   std::span<std::uint8_t> stores) {
    constexpr int kPeriods = 4;
    std::int64_t end[2] = {0, 0};
    for (int n = 0; n < kPeriods; ++n)
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            const auto begin = std::int64_t{n} * period_slots + exposures[i].first_slot;
            const unsigned store = end[0] <= begin ? 0 : 1;
            end[store] = begin + exposures[i].span_slots();
            if (n >= kPeriods - 2)
                stores[i] = static_cast<std::uint8_t>(stores[i] | store << (n % 2));
        }
}

}  // namespace

ExposureSchedule::ExposureSchedule(int tile_rows, int tile_cols, int period_slots,
                                   std::vector<std::uint32_t> first,
                                   std::vector<Exposure> exposures)
    : tile_rows_(tile_rows), tile_cols_(tile_cols), period_slots_(period_slots) {
    if (tile_rows < 1 || tile_cols < 1 || tile_rows > kMaxTileSide || tile_cols > kMaxTileSide)
        throw InputError(kWhere, fmt::format("tile {} x {} is outside 1..{} rows and columns",
                                             tile_rows, tile_cols, kMaxTileSide));
    if (period_slots < 1 || period_slots > kMaxPeriodSlots)
        throw InputError(
            kWhere, fmt::format("period {} is outside 1..{} slots", period_slots, kMaxPeriodSlots));
    if (first.size() != pixels() + 1 || first.front() != 0 || first.back() != exposures.size() ||
        !std::is_sorted(first.begin(), first.end()))
        throw InputError(kWhere, "the list of exposures does not match the tile");
    std::vector<int> zeros(index(period_slots), 0);
    auto lists = std::make_shared<Lists>();
    lists->first = std::move(first);
    lists->exposures = std::move(exposures);
    for (int pixel = 0; pixel < tile_rows * tile_cols; ++pixel) check_pixel(*lists, pixel, zeros);
    if (lists->max_at_once == 2) assign_stores(*lists);
    list_due_pixels(*lists);
    lists_ = std::move(lists);
}

void ExposureSchedule::check_pixel(Lists& lists, int pixel, std::span<int> zeros) const {
    const auto fail = [&](std::uint32_t slot, std::string_view problem) {
        throw InputError(kWhere, fmt::format("pixel ({}, {}) slot {}: {}", pixel / tile_cols_,
                                             pixel % tile_cols_, slot, problem));
    };
    const auto begin = lists.exposures.begin() + lists.first[index(pixel)];
    const auto end = lists.exposures.begin() + lists.first[index(pixel) + 1];
    std::sort(begin, end,
              [](const Exposure& a, const Exposure& b) { return a.first_slot < b.first_slot; });
    const auto period = static_cast<std::uint32_t>(period_slots_);
    const auto visit_open = [&](const Exposure& e, const auto& visit) {
        for (std::uint64_t rest = e.open_slots; rest != 0; rest &= rest - 1)
            visit((e.first_slot + static_cast<std::uint32_t>(std::countr_zero(rest))) % period);
    };
    std::uint32_t covered_slots = 0;
    bool interleaved = false;
    for (auto e = begin; e != end; ++e) {
        if (e->first_slot >= period) fail(e->first_slot, "an exposure begins beyond the period");
        if ((e->open_slots & 1U) == 0)
            fail(e->first_slot, "an exposure is closed in its first slot");
        if (e->span_slots() > period_slots_) fail(e->first_slot, "an exposure exceeds the period");
        visit_open(*e, [&](std::uint32_t slot) {
            if (zeros[slot]++ != 0) fail(slot, "two exposures share this slot");
        });
        covered_slots += static_cast<std::uint32_t>(e->span_slots());
        lists.longest_span_slots = std::max(lists.longest_span_slots, e->span_slots());
        const auto next_begin = e + 1 == end ? begin->first_slot + period : (e + 1)->first_slot;
        if (e->first_slot + static_cast<std::uint32_t>(e->span_slots()) > next_begin)
            interleaved = true;
    }
    for (auto e = begin; e != end; ++e)
        visit_open(*e, [&](std::uint32_t slot) { zeros[slot] = 0; });
    if (interleaved || covered_slots > period)
        lists.max_at_once = std::max(lists.max_at_once, max_at_once({begin, end}, zeros));
}

void ExposureSchedule::assign_stores(Lists& lists) const {
    lists.stores.assign(lists.exposures.size(), 0);
    for (std::size_t p = 0; p < pixels(); ++p)
        choose_stores(exposures_in(lists, p), period_slots_,
                      std::span(lists.stores).subspan(lists.first[p]));
}

void ExposureSchedule::list_due_pixels(Lists& lists) const {
    const auto period = static_cast<std::uint32_t>(period_slots_);
    const auto list_of = [&](const Exposure& e, int tile_row) {
        const auto last = e.first_slot + static_cast<std::uint32_t>(e.span_slots()) - 1;
        return index(static_cast<int>(last % period) * tile_rows_ + tile_row);
    };
    std::vector<std::uint32_t>& first_due = lists.first_due;
    first_due.assign(index(period_slots_) * index(tile_rows_) + 1, 0);
    for (int row = 0; row < tile_rows_; ++row)
        for (int col = 0; col < tile_cols_; ++col)
            for (const Exposure& e : exposures_in(lists, pixel(row, col)))
                ++first_due[list_of(e, row) + 1];
    std::partial_sum(first_due.begin(), first_due.end(), first_due.begin());
    lists.due.resize(lists.exposures.size());
    std::vector<std::uint32_t> next(first_due.begin(), first_due.end() - 1);
    for (int row = 0; row < tile_rows_; ++row)
        for (int col = 0; col < tile_cols_; ++col)
            for (const Exposure& e : exposures_in(lists, pixel(row, col)))
                lists.due[next[list_of(e, row)]++] = {static_cast<std::uint16_t>(col),
                                                      static_cast<std::uint8_t>(e.span_slots()),
                                                      static_cast<std::uint8_t>(e.light_slots())};
}

std::span<const Exposure> ExposureSchedule::exposures(int tile_row, int tile_col) const {
    return exposures_in(*lists_, pixel(tile_row, tile_col));
}

std::span<const DuePixel> ExposureSchedule::due(int phase, int tile_row) const {
    const auto list = index(phase) * index(tile_rows_) + index(tile_row);
    const std::vector<std::uint32_t>& first = lists_->first_due;
    return std::span(lists_->due).subspan(first[list], first[list + 1] - first[list]);
}

double ExposureSchedule::samples_per_pixel_slot() const {
    const double pixel_slots = 1.0 * tile_rows_ * tile_cols_ * period_slots_;
    return static_cast<double>(lists_->exposures.size()) / pixel_slots;
}

void ExposureSchedule::set_weights(std::vector<float> weights) {
    const std::size_t pixels = this->pixels();
    const std::size_t period = index(period_slots_);
    if (weights.size() != pixels * period)
        throw InputError(kWhere, fmt::format("{} weights for a tile of {} x {} pixels and {} slots",
                                             weights.size(), tile_rows_, tile_cols_, period));
    const auto columns = static_cast<std::size_t>(tile_cols_);
    std::vector<std::uint8_t> open(period);
    bool all_one = true;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        std::ranges::fill(open, std::uint8_t{0});
        for (const Exposure& e : exposures_in(*lists_, pixel))
            for (std::uint64_t rest = e.open_slots; rest != 0; rest &= rest - 1)
                open[(e.first_slot + index(std::countr_zero(rest))) % period] = 1;
        for (std::size_t slot = 0; slot < period; ++slot) {
            const float weight = weights[slot * pixels + pixel];
            const bool good = open[slot] != 0 ? weight >= kMinSlotWeight && weight <= kMaxSlotWeight
                                              : weight == 0;
            if (!good)
                throw InputError(
                    kWhere, fmt::format("pixel ({}, {}) slot {}: weight {} of {} slot is not {}",
                                        pixel / columns, pixel % columns, slot, weight,
                                        open[slot] != 0 ? "an open" : "a closed",
                                        open[slot] != 0 ? "in 2^-20..2^20" : "0"));
            all_one = all_one && (open[slot] == 0 || weight == 1);
        }
    }
    weights_ = all_one ? std::vector<float>{} : std::move(weights);
}

double ExposureSchedule::light_slots(int tile_row, int tile_col, const Exposure& exposure) const {
    if (!weighted()) return exposure.light_slots();
    double sum = 0;
    for (std::uint64_t rest = exposure.open_slots; rest != 0; rest &= rest - 1) {
        const auto slot = exposure.first_slot + static_cast<std::uint32_t>(std::countr_zero(rest));
        const auto phase = static_cast<int>(slot % static_cast<std::uint32_t>(period_slots_));
        sum += static_cast<double>(weight(phase, tile_row, tile_col));
    }
    return sum;
}

double ExposureSchedule::light_throughput() const {
    if (!weighted()) return open_fraction();
    const double light = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    return light / static_cast<double>(weights_.size());
}

double ExposureSchedule::open_fraction() const {
    const double pixel_slots = 1.0 * tile_rows_ * tile_cols_ * period_slots_;
    double light_slots = 0;
    for (const Exposure& e : lists_->exposures) light_slots += e.light_slots();
    return light_slots / pixel_slots;
}

bool ExposureSchedule::gapless() const {
    return open_fraction() == 1.0;
}

bool ExposureSchedule::operator==(const ExposureSchedule& other) const {
    return tile_rows_ == other.tile_rows_ && tile_cols_ == other.tile_cols_ &&
           period_slots_ == other.period_slots_ && weights_ == other.weights_ &&
           (lists_ == other.lists_ ||
            (lists_->first == other.lists_->first && lists_->exposures == other.lists_->exposures));
}

std::size_t count_due(const ExposureSchedule& schedule, std::int64_t slot, int first_row, int rows,
                      int cols) {
    std::size_t count = 0;
    if (slot + 1 >= schedule.longest_span_slots() && cols % schedule.tile_cols() == 0) {
        const auto phase = static_cast<int>(slot % schedule.period_slots());
        for (int row = first_row; row < first_row + rows; ++row)
            count += schedule.due(phase, row % schedule.tile_rows()).size();
        return count * index(cols / schedule.tile_cols());
    }
    for (int row = first_row; row < first_row + rows; ++row)
        for_each_readout(schedule, slot, row, cols, [&](int, int) { ++count; });
    return count;
}

RandomExposures::RandomExposures(std::span<const int> exposure_slots, std::uint64_t seed)
    : exposure_slots_(exposure_slots.begin(), exposure_slots.end()),
      seed_(seed),
      order_(exposure_slots.size()),
      exposures_(exposure_slots.size()) {
    if (exposure_slots.empty()) throw InputError(kWhere, "there is no exposure length");
    for (const int length : exposure_slots) {
        if (length < 1 || length > kMaxExposureSlots)
            throw InputError(kWhere, fmt::format("exposure of {} slots is outside 1..64", length));
        period_slots_ += length;
    }
}

std::span<const Exposure> RandomExposures::of(std::uint32_t pixel) {
    // Fisher-Yates; draw i uses word 0 of its own block, scaled to its range by a high product.
    const auto draw = [&](std::size_t i, std::size_t range) {
        const auto word = philox4x32(
            random_address(pixel, static_cast<std::uint32_t>(i), RandomPurpose::kSchedule),
            seed_)[0];
        return static_cast<std::uint32_t>((std::uint64_t{word} * range) >> 32U);
    };
    std::ranges::copy(exposure_slots_, order_.begin());
    for (std::size_t i = order_.size() - 1; i > 0; --i)
        std::swap(order_[i], order_[draw(i, i + 1)]);
    const auto period = static_cast<std::uint32_t>(period_slots_);
    std::uint32_t slot = draw(0, period);
    auto first = exposures_.begin();  // of the period
    for (std::size_t i = 0; i < order_.size(); ++i) {
        if (slot >= period) {
            slot -= period;
            first = exposures_.begin() + static_cast<std::ptrdiff_t>(i);
        }
        exposures_[i] = {slot, open_without_gap(order_[i])};
        slot += static_cast<std::uint32_t>(order_[i]);
    }
    std::rotate(exposures_.begin(), first, exposures_.end());
    return exposures_;
}

ExposureSchedule random_schedule(int rows, int cols, std::span<const int> exposure_slots,
                                 std::uint64_t seed) {
    RandomExposures random(exposure_slots, seed);
    const auto pixels = static_cast<std::uint32_t>(rows) * static_cast<std::uint32_t>(cols);
    std::vector<std::uint32_t> first(pixels + 1);
    std::vector<Exposure> exposures;
    exposures.reserve(pixels * exposure_slots.size());
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const auto of_pixel = random.of(pixel);
        exposures.insert(exposures.end(), of_pixel.begin(), of_pixel.end());
        first[pixel + 1] = static_cast<std::uint32_t>(exposures.size());
    }
    return {rows, cols, random.period_slots(), std::move(first), std::move(exposures)};
}

std::uint64_t random_schedule_bytes(int rows, int cols, std::span<const int> exposure_slots) {
    const std::uint64_t pixels = index(rows) * index(cols);
    const std::uint64_t exposure_bytes = sizeof(Exposure) + sizeof(DuePixel);
    const int period_slots = std::accumulate(exposure_slots.begin(), exposure_slots.end(), 0);
    return pixels * (exposure_slots.size() * exposure_bytes + sizeof(std::uint32_t)) +
           2 * sizeof(std::uint32_t) * index(rows) * index(period_slots);
}

}  // namespace stipple
