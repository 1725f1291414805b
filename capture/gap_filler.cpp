#include "capture/gap_filler.h"

#include <algorithm>
#include <utility>

namespace stipple {
namespace {

constexpr std::uint64_t kMaxHeld = std::uint64_t{1} << 40U;

}  // namespace

GapFiller::Gap GapFiller::next(const FrameRecord& record, bool is_used) {
    const bool goes_on = last_id_ && record.id > *last_id_;
    const std::uint64_t by_ids = goes_on ? record.id - *last_id_ - 1 : 0;
    last_id_ = record.id;
    Gap gap{.lost = std::max(record.lost_before, by_ids)};
    if (has_used_) gap.held = std::min(gap.lost, kMaxHeld) + (is_used ? 0 : 1);
    has_used_ = has_used_ || is_used;
    return gap;
}

}  // namespace stipple
