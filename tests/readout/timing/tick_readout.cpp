#include "tests/readout/timing/tick_readout.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stipple {
namespace {

/// The clockwork of a chip: each machine has a state and counts its own clocks down. `step` lets
/// one clock pass; states of 0 clocks are gone through in no time.
class Clockwork {
  public:
    Clockwork(const ReadoutTiming& timing, int cols, std::span<const RowLoad> loads,
              std::int64_t begin)
        : timing_(timing),
          settle_(settle_of(timing, loads)),
          turns_(timing.row_timing == RowTiming::kSequential),
          now_(begin),
          free_latches_(turns_ ? 1 : 2) {
        for (const RowLoad& load : loads) rows_.push_back({.load = load});
        overhead_left_ = timing.overhead_clocks;
        overhead_rows_left_ = timing.overhead_rows;
        full_row_clocks_ = full_row_clocks(timing, cols);
    }

    [[nodiscard]] bool done() const { return ended_ == rows_.size(); }
    [[nodiscard]] int settle() const { return settle_; }
    [[nodiscard]] std::vector<RowTimes> take_rows() { return std::move(rows_); }
    void step();

  private:
    enum class Columns { kWait, kSelect, kConvert, kRest };
    enum class Link { kWait, kTransfer, kRest };
    /// A row that the link has begun, until its time is over.
    struct RowTime {
        std::size_t row;
        std::int64_t left;
    };

    bool enter_overhead();
    bool enter_columns();
    bool enter_link();
    bool end_rows();
    bool begin_select();
    static void pass(std::int64_t& left) { left -= left > 0 ? 1 : 0; }

    const ReadoutTiming& timing_;
    int settle_;
    bool turns_;
    std::int64_t now_;
    std::vector<RowTimes> rows_;

    std::int64_t overhead_left_ = 0;  ///< of the fixed overhead or of an overhead row
    int overhead_rows_left_ = 0;
    bool in_last_overhead_row_ = false;
    bool overhead_over_ = false;
    std::int64_t full_row_clocks_ = 0;

    Columns columns_ = Columns::kWait;
    std::int64_t columns_left_ = 0;
    std::size_t selected_ = 0;  ///< rows
    int next_row_ = 0;          ///< where the row pointer stands
    int free_latches_;

    Link link_ = Link::kWait;
    std::int64_t link_left_ = 0;
    std::size_t ready_ = 0;  ///< rows that are converted
    std::size_t sent_ = 0;   ///< rows of which the transfer began
    std::vector<RowTime> row_times_;
    std::size_t ended_ = 0;
};

bool Clockwork::enter_overhead() {
    if (overhead_over_ || overhead_left_ > 0) return false;
    overhead_over_ = overhead_rows_left_ == 0;
    if (overhead_over_) return true;
    in_last_overhead_row_ = --overhead_rows_left_ == 0;
    overhead_left_ = full_row_clocks_;
    return true;
}

bool Clockwork::begin_select() {
    const bool may_begin = overhead_over_ || (in_last_overhead_row_ && !turns_);
    if (selected_ == rows_.size() || free_latches_ == 0 || !may_begin) return false;
    RowTimes& row = rows_[selected_];
    if (selected_ == 0) next_row_ = -timing_.dark_rows;
    columns_left_ = timing_.rot_clocks;
    for (; next_row_ < row.load.row; ++next_row_) columns_left_ += timing_.skip_row_clocks;
    ++next_row_;
    --free_latches_;
    row.select = now_;
    columns_ = Columns::kSelect;
    return true;
}

bool Clockwork::enter_columns() {
    if (columns_left_ > 0) return false;
    switch (columns_) {
        case Columns::kWait:
            return begin_select();
        case Columns::kSelect: {
            RowTimes& row = rows_[selected_];
            row.convert = now_;
            columns_left_ = settle_;
            for (int i = 0; i < row.load.conversions; ++i) columns_left_ += timing_.adc_clocks;
            columns_ = Columns::kConvert;
            return true;
        }
        case Columns::kConvert:
            rows_[selected_].convert_end = now_;
            columns_left_ = turns_ ? 0 : timing_.blanking_clocks;
            columns_ = Columns::kRest;
            return true;
        case Columns::kRest:
            ++selected_;
            ++ready_;
            columns_ = Columns::kWait;
            return true;
    }
    return false;
}

bool Clockwork::enter_link() {
    if (link_left_ > 0) return false;
    switch (link_) {
        case Link::kWait: {
            if (sent_ == ready_ || !overhead_over_) return false;
            RowTimes& row = rows_[sent_];
            row.transfer = now_;
            link_left_ = transfer_clocks(timing_, row.load.channel_columns);
            const std::int64_t convert = timing_.rot_clocks + row.convert_end - row.convert;
            row_times_.push_back({sent_, turns_ ? link_left_ : std::max(link_left_, convert)});
            link_ = Link::kTransfer;
            return true;
        }
        case Link::kTransfer:
            rows_[sent_].transfer_end = now_;
            link_left_ = timing_.blanking_clocks;
            link_ = Link::kRest;
            return true;
        case Link::kRest:
            ++sent_;
            ++free_latches_;
            link_ = Link::kWait;
            return true;
    }
    return false;
}

bool Clockwork::end_rows() {
    const auto over = [&](const RowTime& time) {
        if (time.left > 0) return false;
        rows_[time.row].frame_end = now_ + timing_.blanking_clocks;
        ++ended_;
        return true;
    };
    return std::erase_if(row_times_, over) > 0;
}

void Clockwork::step() {
    bool changed = true;
    while (changed) {
        changed = enter_overhead();
        changed = enter_columns() || changed;
        changed = enter_link() || changed;
        changed = end_rows() || changed;
    }
    pass(overhead_left_);
    pass(columns_left_);
    pass(link_left_);
    for (RowTime& time : row_times_) pass(time.left);
    ++now_;
}

}  // namespace

SlotTimes read_slot_by_ticks(const ReadoutTiming& timing, int cols, std::span<const RowLoad> loads,
                             std::int64_t begin) {
    Clockwork clockwork(timing, cols, loads, begin);
    while (!clockwork.done()) clockwork.step();
    SlotTimes times{
        .settle = clockwork.settle(), .begin = begin, .end = begin, .rows = clockwork.take_rows()};
    if (!times.rows.empty()) times.end = times.rows.back().frame_end;
    return times;
}

}  // namespace stipple
