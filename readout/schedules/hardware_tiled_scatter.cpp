#include "readout/schedules/hardware_tiled_parts.h"

#include <algorithm>
#include <numeric>

namespace stipple {
namespace {

constexpr int kMaxRests = 24;        ///< ways to fill a rest that are kept
constexpr int kMaxRestSteps = 4000;  ///< changes tried for each
constexpr int kFewRests = 6;  ///< with fewer, rows would be in phase: each channel is even alone

using Codes = std::vector<GroupCode>;

GroupCode draw_code(const CodeSet& codes, Draws& draws) {
    const auto order = draws.below(static_cast<std::size_t>(codes.orders()));
    const auto slot = draws.below(static_cast<std::size_t>(codes.period()));
    return {static_cast<std::uint16_t>(order), static_cast<std::uint16_t>(slot)};
}

/// How many of some codes are due in each slot.
class DueCounts {
  public:
    explicit DueCounts(const CodeSet& codes)
        : codes_(&codes), due_(static_cast<std::size_t>(codes.period())) {}

    void add(GroupCode code, int times) {
        for (const int slot : codes_->due(code.order))
            due_[static_cast<std::size_t>((slot + code.first_slot) % codes_->period())] += times;
    }
    /// Sum of the squares of what differs from `other`.
    [[nodiscard]] std::int64_t distance2(const DueCounts& other) const {
        std::int64_t sum = 0;
        for (std::size_t slot = 0; slot < due_.size(); ++slot) {
            const std::int64_t difference = due_[slot] - other.due_[slot];
            sum += difference * difference;
        }
        return sum;
    }

  private:
    const CodeSet* codes_;
    std::vector<int> due_;
};

/// `size` codes whose counts come as near to `target` as a search finds.
Codes search(const CodeSet& codes, std::size_t size, const DueCounts& target, Draws& draws) {
    Codes found(size);
    DueCounts counts(codes);
    for (GroupCode& code : found) {
        code = draw_code(codes, draws);
        counts.add(code, 1);
    }
    std::int64_t distance2 = counts.distance2(target);
    for (int step = 0; step < kMaxRestSteps && distance2 > 0; ++step) {
        GroupCode& code = found[draws.below(size)];
        const GroupCode other = draw_code(codes, draws);
        counts.add(code, -1);
        counts.add(other, 1);
        const std::int64_t changed = counts.distance2(target);
        if (changed <= distance2) {
            distance2 = changed;
            code = other;
        } else {
            counts.add(other, -1);
            counts.add(code, 1);
        }
    }
    return found;
}

DueCounts count(const CodeSet& codes, const Codes& list) {
    DueCounts counts(codes);
    for (const GroupCode code : list) counts.add(code, 1);
    return counts;
}

/// Ways to fill what whole sets of codes leave of a channel's groups in a row.
class Rests {
  public:
    Rests(const CodeSet& codes, std::size_t size, Draws& draws) : codes_(codes) {
        if (size == 0) return;
        const DueCounts none(codes);
        std::vector<Codes> even;  // distance to none: sum of squares, least where most even
        even.reserve(kMaxRests);
        for (int i = 0; i < kMaxRests; ++i) even.push_back(search(codes, size, none, draws));
        const auto roughness = [&](const Codes& list) {
            return count(codes, list).distance2(none);
        };
        std::ranges::stable_sort(even, {}, roughness);
        const DueCounts target = count(codes, even.front());
        rests_.push_back(even.front());
        for (int i = 1; i < kMaxRests; ++i) {
            Codes rest = search(codes, size, target, draws);
            if (count(codes, rest).distance2(target) == 0) rests_.push_back(std::move(rest));
        }
        for (Codes& rest : rests_) std::ranges::sort(rest);
        std::ranges::sort(rests_);
        rests_.erase(std::unique(rests_.begin(), rests_.end()), rests_.end());
        alike_ = rests_.size() >= kFewRests;
        if (!alike_) rests_ = std::move(even);
    }

    /// Appends one, moved by `shift` slots if all have the same load, else by any number.
    void append(Codes& list, std::uint32_t shift, Draws& draws) const {
        if (rests_.empty()) return;
        const auto period = static_cast<std::uint32_t>(codes_.period());
        if (!alike_) shift = draws.below(period);
        for (const GroupCode code : rests_[draws.below(rests_.size())])
            list.push_back(
                {code.order, static_cast<std::uint16_t>((code.first_slot + shift) % period)});
    }

  private:
    const CodeSet& codes_;
    std::vector<Codes> rests_;
    bool alike_ = true;
};

/// Appends each order's codes from every slot of the period: as many due in every slot.
void append_sets(const CodeSet& codes, std::size_t sets, Codes& list, Draws& draws) {
    for (std::size_t i = 0; i < sets; ++i) {
        const auto order = draws.below(static_cast<std::size_t>(codes.orders()));
        for (int slot = 0; slot < codes.period(); ++slot)
            list.push_back({static_cast<std::uint16_t>(order), static_cast<std::uint16_t>(slot)});
    }
}

/// Rows that are as even as can be, in random order.
void fill_rows(GroupTile& tile, int classes, const CodeSet& codes, Draws& draws) {
    const auto size = static_cast<std::size_t>(tile.cols / classes);
    const auto period = static_cast<std::uint32_t>(codes.period());
    const Rests rests(codes, size % period, draws);
    std::uint32_t shift = 0;
    Codes list;
    for (int row = 0; row < tile.rows; ++row) {
        // Rows whose rest is due a little later each fill the slots evenly together.
        shift = row % codes.period() == 0 ? draws.below(period) : (shift + 1) % period;
        for (int channel = 0; channel < classes; ++channel) {
            list.clear();
            append_sets(codes, size / period, list, draws);
            rests.append(list, shift, draws);
            shuffle(list, draws);
            for (std::size_t i = 0; i < size; ++i)
                tile.at(row, channel + static_cast<int>(i) * classes) = list[i];
        }
    }
}

}  // namespace

GroupTile scatter_tile(const GroupGrid& grid, const CodeSet& codes, int rows, int cols,
                       Draws& draws) {
    GroupTile tile(rows, cols);
    const int classes = std::gcd(cols, grid.channel_classes);
    fill_rows(tile, classes, codes, draws);
    anneal_frame_potential(tile, grid, codes, draws);
    return tile;
}

GroupTile random_tile(const CodeSet& codes, int rows, int cols, Draws& draws) {
    GroupTile tile(rows, cols);
    for (GroupCode& code : tile.codes) code = draw_code(codes, draws);
    return tile;
}

}  // namespace stipple
