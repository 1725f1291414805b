#include "readout/timing/stretched_slots.h"

#include "core/config.h"
#include "core/error.h"
#include "readout/provenance.h"
#include "readout/timing/readout_cost.h"

namespace stipple {
namespace {

/// Slots without packets; more are not gone through.
constexpr std::int64_t kMostSkipped = 1 << 20;

ExposureSchedule whole_schedule(const StreamHeader& header) {
    const auto& [kind, exposure_slots, seed] = header.schedule_source;
    return kind == ScheduleSource::Kind::kRandom
               ? random_schedule(header.shape.rows, header.shape.cols, exposure_slots, seed)
               : header.schedule;
}

}  // namespace

struct StretchedSlots::Readout {
    Readout(const ReadoutTiming& timing, const StreamHeader& header)
        : schedule(whole_schedule(header)),
          cost(timing, schedule, header.shape,
               {slot_clocks(timing, header.slot_us), OverrunPolicy::kStretch}) {}

    ExposureSchedule schedule;
    ReadoutCost cost;
};

StretchedSlots::StretchedSlots(const StreamHeader& header, std::uint64_t max_bytes)
    : header_(header), max_bytes_(max_bytes) {}

void StretchedSlots::set_up() {
    if (header_.may_switch) return;  // of several schedules
    const auto& [kind, exposure_slots, seed] = header_.schedule_source;
    if (kind == ScheduleSource::Kind::kRandom &&
        random_schedule_bytes(header_.shape.rows, header_.shape.cols, exposure_slots) > max_bytes_)
        return;
    try {
        Config config(timing_settings(header_.provenance));
        if (const auto timing = read_timing(config, header_.calibration.bit_depth))
            readout_ = std::make_unique<Readout>(*timing, header_);
    } catch (const InputError&) {
        // A text for people: it need not tell a timing, nor one of this schedule.
    }
}

StretchedSlots::~StretchedSlots() = default;

void StretchedSlots::add(const SamplePacket& packet) {
    if ((packet.flags & SamplePacket::kOverrun) == 0 || packet.first_row != 0) return;
    if (slots_++ == 0) set_up();
    if (!readout_) return;
    ReadoutCost& cost = readout_->cost;
    if (packet.slot - cost.slots() > kMostSkipped) return readout_.reset();
    std::int64_t clocks = 0;
    while (cost.slots() <= packet.slot) clocks = cost.add_next().clocks;
    total_us_ += static_cast<double>(clocks) / static_cast<double>(cost.timing().clock_hz) * 1e6;
}

std::optional<double> StretchedSlots::mean_us() const {
    if (!readout_ || slots_ == 0) return std::nullopt;
    return total_us_ / static_cast<double>(slots_);
}

}  // namespace stipple
