#include "capture/frame_sequence.h"

#include <algorithm>
#include <utility>

namespace stipple {
namespace {

std::int64_t stamp_ns(const FrameRecord& record) {
    const bool none = record.stamp_source == StampSource::kNone ||
                      record.stamp_source == StampSource::kUnnamedClock;
    return none ? record.host_monotonic_ns : record.device_ns;
}

constexpr std::uint64_t kMaxHeld = std::uint64_t{1} << 40U;

}  // namespace

void FrameRate::add(const FrameRecord& record) {
    const bool is_new = !first_ || first_->epoch != record.epoch ||
                        first_->stamp_source != record.stamp_source || record.id < last_.id ||
                        stamp_ns(record) < stamp_ns(last_);
    if (is_new) first_ = record;
    last_ = record;
}

double FrameRate::seconds() const {
    // Unsigned: stamps of a damaged file may be any numbers.
    return first_ ? static_cast<double>(static_cast<std::uint64_t>(stamp_ns(last_)) -
                                        static_cast<std::uint64_t>(stamp_ns(*first_))) *
                        1e-9
                  : 0;
}

std::uint64_t FrameRate::periods() const {
    return first_ ? last_.id - first_->id : 0;
}

std::optional<double> FrameRate::hz() const {
    if (periods() == 0 || seconds() <= 0) return std::nullopt;
    return static_cast<double>(periods()) / seconds();
}

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
