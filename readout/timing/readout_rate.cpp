#include "readout/timing/readout_rate.h"

#include <algorithm>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"

namespace stipple {
namespace {

double per_second(const ReadoutTiming& timing, double clocks) {
    return static_cast<double>(timing.clock_hz) / clocks;
}

/// Energy of a readout of the whole window, which needs no exposure code.
double full_energy_pj(ReadoutTiming timing, FrameShape shape) {
    timing.code_bit_pj = 0;
    const ExposureSchedule every_slot = full_schedule(1, 1);
    return ScanCosts(timing, every_slot, shape).of(0).counts.energy_pj;
}

/// Scans in succession that take `clocks` and must end within `slots`.
struct ScanWindow {
    std::int64_t clocks = 0;
    std::int64_t slots = 1;
    std::int64_t last_slot = -1;  ///< -1: the mean of all scans

    [[nodiscard]] double slot_clocks() const {
        return static_cast<double>(clocks) / static_cast<double>(slots);
    }
};

struct SteadyPeriod {
    std::int64_t first = 0;  ///< slot
    int slots = 0;
    std::int64_t scan_clocks = 0;  ///< of all its scans
};

/// Adds the scans of a period to `counts`. \throws InputError if they read nothing.
SteadyPeriod steady_period(ScanCosts& scans, ReadoutCounts& counts) {
    SteadyPeriod period{scans.first_steady_slot(), scans.schedule().period_slots()};
    for (std::int64_t slot = period.first; slot < period.first + period.slots; ++slot)
        counts += scans.of(slot).counts;
    if (counts.samples == 0) throw InputError("exposure schedule", "reads no pixel of the window");
    period.scan_clocks = counts.readout_clocks;
    return period;
}

/// The window that is latest in slots as short as those of `known`; scans wait for those before.
/// Two periods suffice: as slots are not shorter than the mean of the scans, some scan of a period
/// does not wait.
ScanWindow latest_window(ScanCosts& scans, const SteadyPeriod& period, const ScanWindow& known) {
    const double slot_clocks = known.slot_clocks();
    ScanWindow latest = known;
    double most_late = 0;
    ScanWindow busy{.clocks = 0, .slots = 0};  ///< scans since the last one that did not wait
    for (std::int64_t slot = period.first; slot < period.first + 2 * period.slots; ++slot) {
        const ScanCost& scan = scans.of(slot);
        for (const ScanDeadline& deadline : scan.deadlines) {
            const ScanWindow window{busy.clocks + deadline.end, busy.slots + deadline.slots, slot};
            const double late = static_cast<double>(window.clocks) -
                                slot_clocks * static_cast<double>(window.slots);
            if (late <= most_late) continue;
            most_late = late;
            latest = window;
        }
        busy.clocks += scan.counts.readout_clocks;
        ++busy.slots;
        if (static_cast<double>(busy.clocks) <= slot_clocks * static_cast<double>(busy.slots))
            busy = {.clocks = 0, .slots = 0};
    }
    return latest;
}

/// The window that sets the slots of a sensor that exposes while it reads: the one of the greatest
/// ratio, by Dinkelbach's method.
ScanWindow slowest_window(ScanCosts& scans, const SteadyPeriod& period) {
    ScanWindow slowest{.clocks = period.scan_clocks, .slots = period.slots};
    for (ScanWindow next = latest_window(scans, period, slowest);
         next.slot_clocks() > slowest.slot_clocks(); next = latest_window(scans, period, slowest))
        slowest = next;
    return slowest;
}

/// The same for one that cannot expose while it reads: from one readout to the next it exposes, and
/// reads.
ScanWindow slowest_pause(ScanCosts& scans, const SteadyPeriod& period,
                         std::int64_t exposure_clocks) {
    ScanWindow slowest{.clocks = 0, .slots = 1};
    ScanWindow since{.clocks = 0, .slots = 0};
    for (std::int64_t slot = period.first; slot < period.first + 2 * period.slots; ++slot) {
        if (scans.exposes(slot)) since.clocks += exposure_clocks;
        ++since.slots;
        const ScanCost& scan = scans.of(slot);
        if (scan.deadlines.empty()) continue;
        since.clocks += scan.counts.readout_clocks;
        since.last_slot = slot;
        // Before the first readout of the first period nothing is known.
        if (slot >= period.first + period.slots && since.slot_clocks() > slowest.slot_clocks())
            slowest = since;
        since = {.clocks = 0, .slots = 0};
    }
    return slowest;
}

/// Of the slots of a steady period, if samples could wait as long as they like.
double mean_slot_clocks(const ScanCosts& scans, const SteadyPeriod& period,
                        std::int64_t exposure_clocks) {
    std::int64_t clocks = period.scan_clocks;
    if (!scans.timing().exposes_while_reading)
        for (std::int64_t slot = period.first; slot < period.first + period.slots; ++slot)
            clocks += scans.exposes(slot) ? exposure_clocks : 0;
    return std::max(static_cast<double>(clocks) / period.slots,
                    static_cast<double>(scans.timing().code_load_clocks));
}

std::int64_t longest_scan(ScanCosts& scans, const SteadyPeriod& period) {
    std::int64_t longest = period.first;
    for (std::int64_t slot = period.first; slot < period.first + period.slots; ++slot)
        if (scans.of(slot).counts.readout_clocks > scans.of(longest).counts.readout_clocks)
            longest = slot;
    return longest;
}

void set_slowest(ScanCosts& scans, const SteadyPeriod& period, std::int64_t exposure_clocks,
                 ReadoutRate& rate) {
    ScanWindow slowest = scans.timing().exposes_while_reading
                             ? slowest_window(scans, period)
                             : slowest_pause(scans, period, exposure_clocks);
    const auto code_load = static_cast<double>(scans.timing().code_load_clocks);
    rate.min_slot_clocks = std::max({slowest.slot_clocks(), code_load, 1.0});
    const bool by_code = rate.min_slot_clocks > slowest.slot_clocks();
    const std::int64_t slot =
        slowest.last_slot < 0 || by_code ? longest_scan(scans, period) : slowest.last_slot;
    rate.slowest = scans.of(slot);
    if (by_code) rate.slowest.limit = ReadoutLimit::kCodeLoad;
    rate.slowest_phase = slot % period.slots;
    rate.deadline_slots = rate.slowest.deadlines.front().slots;
}

}  // namespace

ReadoutRate rate_of(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape,
                    std::int64_t exposure_clocks) {
    ReadoutRate rate;
    rate.full = full_readout(timing, shape);
    rate.full_energy_pj = full_energy_pj(timing, shape);
    ScanCosts scans(timing, schedule, shape);
    const SteadyPeriod period = steady_period(scans, rate.period);
    set_slowest(scans, period, exposure_clocks, rate);
    rate.mean_slot_clocks = mean_slot_clocks(scans, period, exposure_clocks);
    const double samples_per_slot = static_cast<double>(rate.period.samples) / period.slots;
    rate.balanced =
        balanced_readout(timing, shape, samples_per_slot / static_cast<double>(shape.sites()));
    const double balanced_clocks =
        std::max(rate.balanced.total, static_cast<double>(scans.timing().code_load_clocks));
    rate.full_hz = per_second(timing, static_cast<double>(rate.full.total));
    rate.coded_hz = per_second(timing, rate.min_slot_clocks);
    rate.mean_coded_hz = per_second(timing, rate.mean_slot_clocks);
    rate.speedup = rate.coded_hz / rate.full_hz;
    rate.balanced_speedup = static_cast<double>(rate.full.total) / balanced_clocks;
    return rate;
}

}  // namespace stipple
