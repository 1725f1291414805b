#include "capture/frame_rate.h"

namespace stipple {
namespace {

std::int64_t stamp_ns(const FrameRecord& record) {
    const bool none = record.stamp_source == StampSource::kNone ||
                      record.stamp_source == StampSource::kUnnamedClock;
    return none ? record.host_monotonic_ns : record.device_ns;
}

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

}  // namespace stipple
