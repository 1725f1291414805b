#include "apps/stretched_slots.h"

#include "apps/provenance.h"
#include "core/config.h"
#include "core/error.h"
#include "readout/readout_account.h"

namespace stipple {

struct StretchedSlots::Readout {
    Readout(const ReadoutTiming& timing, const StreamHeader& header)
        : account(timing, header.schedule, header.shape,
                  {slot_clocks(timing, header.slot_us), OverrunPolicy::kStretch}) {}

    ReadoutAccount account;
};

StretchedSlots::StretchedSlots(const StreamHeader& header) {
    try {
        Config config(timing_settings(header.provenance));
        if (const auto timing = read_timing(config, header.calibration.bit_depth))
            readout_ = std::make_unique<Readout>(*timing, header);
    } catch (const InputError&) {
        // A text for people: it need not tell a timing, nor one of this schedule.
    }
}

StretchedSlots::~StretchedSlots() = default;

void StretchedSlots::add(const SamplePacket& packet) {
    if ((packet.flags & SamplePacket::kOverrun) == 0 || packet.first_row != 0) return;
    ++slots_;
    if (!readout_) return;
    ReadoutAccount& account = readout_->account;
    total_us_ += static_cast<double>(account.of(packet.slot).clocks) /
                 static_cast<double>(account.timing().clock_hz) * 1e6;
}

std::optional<double> StretchedSlots::mean_us() const {
    if (!readout_ || slots_ == 0) return std::nullopt;
    return total_us_ / static_cast<double>(slots_);
}

}  // namespace stipple
