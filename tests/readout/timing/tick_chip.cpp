#include "tests/readout/timing/tick_chip.h"

#include <algorithm>
#include <deque>
#include <functional>

#include "core/exposure_schedule.h"
#include "core/index.h"
#include "tests/readout/timing/tick_readout.h"

namespace stipple {
namespace {

bool any_pixel_open(const ExposureSchedule& schedule, std::int64_t slot) {
    const std::int64_t period = schedule.period_slots();
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& e : schedule.exposures(row, col))
                for (int i = 0; i < e.span_slots(); ++i)
                    if ((e.open_slots >> static_cast<unsigned>(i) & 1U) != 0 &&
                        (std::int64_t{e.first_slot} + i) % period == slot % period)
                        return true;
    return false;
}

class TickChip {
  public:
    TickChip(const ReadoutTiming& timing, std::span<const SchedulePart> parts, FrameShape shape,
             std::int64_t budget)
        : timing_(timing),
          parts_(parts),
          shape_(shape),
          slot_clocks_(std::max({budget, code_load_clocks(timing, shape.rows), std::int64_t{1}})),
          waits_(index(shape.rows)) {}

    std::vector<std::int64_t> lengths(int slots) {
        begin_slot(0);
        while (std::cmp_less(lengths_.size(), slots)) tick();
        return lengths_;
    }

  private:
    std::vector<RowLoad> due_rows(std::int64_t slot) {
        std::vector<RowLoad> loads;
        const SchedulePart& part = parts_[part_at(parts_, slot)];
        RowLoads(timing_, *part.schedule, shape_).list(readout_slot(part, slot), loads);
        return loads;
    }
    void begin_slot(std::int64_t slot) {
        slot_ = slot;
        exposed_ = 0;
        length_ = 0;
        for (const RowLoad& load : due_rows(slot))
            if (load.row >= 0) waits_[index(load.row)] = true;
        queue_.push_back(slot);
        next_is_open_ = any_pixel_open(*parts_[part_at(parts_, slot + 1)].schedule, slot + 1);
    }
    /// The scan that runs; the next one begins as soon as there is one.
    void scan() {
        while (true) {
            for (; next_row_ < rows_.size() && rows_[next_row_].frame_end <= now_; ++next_row_)
                if (rows_[next_row_].load.row >= 0)
                    waits_[index(rows_[next_row_].load.row)] = false;
            if (next_row_ < rows_.size() || queue_.empty()) return;
            rows_ = read_slot_by_ticks(timing_, shape_.cols, due_rows(queue_.front()), now_).rows;
            next_row_ = 0;
            queue_.pop_front();
        }
    }
    [[nodiscard]] bool scans() const { return next_row_ < rows_.size(); }
    [[nodiscard]] bool may_end() {
        if (exposed_ < slot_clocks_) return false;
        if (part_at(parts_, slot_ + 1) != part_at(parts_, slot_))
            return std::ranges::none_of(waits_, std::identity{});
        return std::ranges::none_of(due_rows(slot_ + 1), [&](const RowLoad& load) {
            return load.row >= 0 && waits_[index(load.row)];
        });
    }
    void tick() {
        scan();
        while (may_end()) {
            lengths_.push_back(length_);
            begin_slot(slot_ + 1);
            scan();
        }
        const bool pauses = !timing_.exposes_while_reading && next_is_open_ && scans();
        exposed_ += pauses ? 0 : 1;
        ++length_;
        ++now_;
    }

    const ReadoutTiming& timing_;
    std::span<const SchedulePart> parts_;
    FrameShape shape_;
    std::int64_t slot_clocks_;
    std::vector<bool> waits_;  ///< by row, whether it keeps samples
    std::deque<std::int64_t> queue_;
    std::vector<RowTimes> rows_;  ///< of the scan that runs
    std::size_t next_row_ = 0;    ///< of these
    std::int64_t now_ = 0;
    std::int64_t slot_ = 0;
    std::int64_t exposed_ = 0;
    std::int64_t length_ = 0;
    bool next_is_open_ = false;
    std::vector<std::int64_t> lengths_;
};

}  // namespace

std::vector<std::int64_t> slot_lengths_by_ticks(const ReadoutTiming& timing,
                                                std::span<const SchedulePart> parts,
                                                FrameShape shape, std::int64_t budget, int slots) {
    return TickChip(timing, parts, shape, budget).lengths(slots);
}

}  // namespace stipple
