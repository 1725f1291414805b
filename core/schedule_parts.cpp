#include "core/schedule_parts.h"

#include <algorithm>
#include <bit>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

constexpr std::int64_t kBits = 64;

/// `bits` by `slots` towards higher bits; what leaves the word is lost.
std::uint64_t shifted(std::uint64_t bits, std::int64_t slots) {
    return slots >= kBits ? 0 : bits << static_cast<unsigned>(slots);
}

std::int64_t width(std::uint64_t bits) {
    return static_cast<std::int64_t>(std::bit_width(bits));
}

/// One pixel of a part.
struct PixelPart {
    PixelPart(const SchedulePart& part, int row, int col)
        : exposures(part.schedule->exposures(row % part.schedule->tile_rows(),
                                             col % part.schedule->tile_cols())),
          period(part.schedule->period_slots()),
          first_slot(part.first_slot) {}

    std::span<const Exposure> exposures;
    std::int64_t period;
    std::int64_t first_slot;

    /// The first readout in `slot` or later.
    [[nodiscard]] std::optional<ReadExposure> next_read(std::int64_t slot) const {
        std::int64_t best = period;
        std::optional<ReadExposure> next;
        for (const Exposure& e : exposures) {
            const std::int64_t end = std::int64_t{e.first_slot} + e.span_slots() - 1;
            const std::int64_t wait = ((end - slot) % period + period) % period;
            if (wait >= best) continue;
            best = wait;
            next = {slot + wait - e.span_slots() + 1, e.open_slots};
        }
        return next;
    }
    /// The slot of the last readout before `slot`, in this part.
    [[nodiscard]] std::optional<std::int64_t> last_read(std::int64_t slot) const {
        std::optional<std::int64_t> last;
        for (const Exposure& e : exposures) {
            const std::int64_t end = std::int64_t{e.first_slot} + e.span_slots() - 1;
            const std::int64_t read = slot - 1 - ((slot - 1 - end) % period + period) % period;
            const bool begun = first_slot > 0 ? read >= first_slot : read >= e.span_slots() - 1;
            if (begun) last = std::max(last.value_or(read), read);
        }
        return last;
    }
    /// Open slots before `slot` of the exposure that this part has under way there: bit i is the
    /// slot i + 1 before it.
    [[nodiscard]] std::uint64_t under_way(std::int64_t slot) const {
        const auto next = next_read(slot);
        if (!next || next->first_slot >= slot || (first_slot == 0 && next->first_slot < 0))
            return 0;
        std::uint64_t bits = 0;
        for (std::int64_t at = std::max(next->first_slot, first_slot); at < slot; ++at)
            if ((next->open_slots >> index(at - next->first_slot) & 1U) != 0)
                bits |= std::uint64_t{1} << index(slot - 1 - at);
        return bits;
    }
};

/// Open slots of the pixel before the last part that are not read by then, as of `under_way`.
std::optional<std::uint64_t> unread_before(std::span<const SchedulePart> parts, int row, int col) {
    const std::int64_t end = parts.back().first_slot;
    std::int64_t slot = end;
    std::uint64_t bits = 0;
    while (parts.size() > 1 && end - slot < kBits) {
        if (!parts.back().follows) return std::nullopt;
        parts = parts.first(parts.size() - 1);
        const PixelPart before(parts.back(), row, col);
        bits |= shifted(before.under_way(slot), end - slot);
        if (before.last_read(slot)) break;
        slot = before.first_slot;
    }
    return bits;
}

/// With the open slots before a switch those of the first exposure that is read after it.
ReadExposure joined(std::uint64_t unread, const ReadExposure& next, std::int64_t switch_slot) {
    std::int64_t begin = std::max(next.first_slot, switch_slot);
    std::uint64_t open = next.open_slots >> index(begin - next.first_slot);
    const int closed = std::countr_zero(open);  // the last slot is open
    if (unread == 0) return {begin + closed, open >> static_cast<unsigned>(closed)};
    const std::int64_t first = switch_slot - width(unread);
    open = shifted(open, begin - first);
    for (std::int64_t slot = first; slot < switch_slot; ++slot)
        if ((unread >> index(switch_slot - 1 - slot) & 1U) != 0)
            open |= std::uint64_t{1} << index(slot - first);
    return {first, open};
}

UnreadSlots::Longest longest_of_row(const SchedulePart& last, int row,
                                    std::span<const std::uint64_t> unread_slots) {
    UnreadSlots::Longest longest;
    for (int col = 0; col < static_cast<int>(unread_slots.size()); ++col) {
        const std::uint64_t unread = unread_slots[index(col)];
        const auto next = PixelPart(last, row, col).next_read(last.first_slot);
        if (!next) continue;
        const std::int64_t read = next->first_slot + width(next->open_slots) - 1;
        const std::int64_t first = unread == 0 ? joined(0, *next, last.first_slot).first_slot
                                               : last.first_slot - width(unread);
        if (read - first + 1 > longest.slots) longest = {{read, row, col}, read - first + 1};
    }
    return longest;
}

}  // namespace

std::size_t part_at(std::span<const SchedulePart> parts, std::int64_t slot) {
    const auto after = std::ranges::upper_bound(parts, slot, {}, &SchedulePart::first_slot);
    return index(after - parts.begin()) - 1;
}

std::optional<ReadExposure> read_exposure(std::span<const SchedulePart> parts,
                                          const PixelSlot& at) {
    parts = parts.first(part_at(parts, at.slot) + 1);
    const SchedulePart& part = parts.back();
    const PixelPart pixel(part, at.row, at.col);
    const auto exposure = pixel.next_read(at.slot);
    if (part.first_slot == 0 || pixel.last_read(at.slot)) return exposure;
    const auto unread = unread_before(parts, at.row, at.col);
    if (!unread) return std::nullopt;
    return joined(*unread, *exposure, part.first_slot);
}

void UnreadSlots::pass(std::span<const SchedulePart> parts) {
    const SchedulePart& before = parts[parts.size() - 2];
    const std::int64_t end = parts.back().first_slot;
    const std::int64_t slots = end - before.first_slot;
    constexpr auto kOldest = std::uint64_t{1} << 63U;
    parallel_for(0, shape_.rows, [&](int row) {
        for (int col = 0; col < shape_.cols; ++col) {
            std::uint64_t& unread = unread_[row_major(row, col, shape_.cols)];
            const PixelPart pixel(before, row, col);
            const std::uint64_t old = pixel.last_read(end) ? 0 : unread;
            const bool leaves = old != 0 && slots + width(old) > kBits;
            unread = pixel.under_way(end) | shifted(old, slots) | (leaves ? kOldest : 0);
            if (!parts.back().follows) unread = 0;
        }
    });
}

UnreadSlots::Longest UnreadSlots::longest(const SchedulePart& last) const {
    std::vector<Longest> of_rows(index(shape_.rows));
    parallel_for(0, shape_.rows, [&](int row) {
        const auto unread =
            std::span(unread_).subspan(index(row) * index(shape_.cols), index(shape_.cols));
        of_rows[index(row)] = longest_of_row(last, row, unread);
    });
    return *std::ranges::max_element(of_rows, {}, &Longest::slots);  // the first of equal ones
}

}  // namespace stipple
