#include "apps/output/emulation_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/output/text_layout.h"
#include "readout/timing/readout_figures.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

/// On a chip that is not for sale, with the settling that it takes, a line each; else empty.
std::string hypothetical_text(const ReadoutRate& rate, const ReadoutCost& cost) {
    const ReadoutTiming& timing = cost.timing();
    if (timing.hypothetical.empty()) return {};
    std::string text = fmt::format("hypothetical {}", timing.hypothetical);
    if (!timing.settle_clocks.empty())
        text += fmt::format("; rows settle for {} clocks in full, {} in the slowest readout",
                            rate.full.settle, rate.slowest.settle_clocks);
    for (auto at = text.find("; "); at != std::string::npos; at = text.find("; "))
        text.replace(at, 2, ";\n             ");
    return text + '\n';
}

/// What the slowest readout must not hold up.
std::string deadline_text(const ReadoutRate& rate) {
    if (rate.deadline_slots == 0) return ", while no pixel exposes";
    return " and must end within " + counted(rate.deadline_slots, "slot");
}

/// The upper bound, which holds for schedules that read every row in every slot.
std::string balanced_text(const ReadoutRate& rate) {
    if (rate.balanced_speedup < rate.speedup) return {};
    return fmt::format("; {:.3f} if the load were balanced over the rows", rate.balanced_speedup);
}

}  // namespace

nlohmann::ordered_json readout_json(const ReadoutCost& cost, double light_throughput) {
    return json_of([&](const auto& add) { visit_cost_figures(cost, light_throughput, add); });
}

std::string readout_text(const ReadoutCost& cost) {
    const ReadoutCounts& totals = cost.totals();
    const double slots_hz = static_cast<double>(cost.slots()) / seconds_of(cost);
    const Utilisation use = utilisation(cost);
    std::string text = fmt::format(
        "readout      {} slots/s of the sensor, {:.1f} % of the rows read, ADCs {:.1f} %, link "
        "{:.1f} % busy,\n"
        "             {} bits over the link, {:.4g} uJ; schedule memory {} bits, code {:.4g} "
        "Mbit/s",
        rounded(slots_hz, 5), 100 * use.rows, 100 * use.adc, 100 * use.link, totals.bits,
        totals.energy_pj * 1e-6, schedule_memory_bits(cost.schedule()),
        1e-6 * code_bits_per_second(cost, slots_hz));
    if (cost.overruns() > 0)
        text += fmt::format(
            "\noverruns     in {} of {} clocks rows were not read in time: {}",
            counted(cost.overruns(), "slot"), cost.budget().clocks,
            cost.budget().policy == OverrunPolicy::kDrop
                ? fmt::format("{} samples dropped", totals.dropped_samples)
                : "these are stretched; \"--overrun drop\" keeps the rate and gives up rows");
    return text;
}

nlohmann::ordered_json rate_json(const ReadoutRate& rate, const ReadoutCost& cost) {
    return json_of([&](const auto& add) {
        visit_rate_figures(rate, cost, add);
        visit_period_figures(rate, cost, add);
    });
}

std::string rate_text(const ReadoutRate& rate, const ReadoutCost& cost) {
    const Utilisation use = utilisation(rate, cost);
    const double period = cost.schedule().period_slots();
    return fmt::format(
        "{}window       {} x {} (width x height)\n"
        "full         {} readouts/s: {} clocks, {} a row\n"
        "coded        {} slots/s of {} clocks; the slowest readout takes {} clocks{}\n"
        "speed-up     {:.3f}, limited by {}{}\n"
        "in use       rows {:.1f} %, ADCs {:.1f} %, link {:.1f} %\n"
        "energy       {:.4g} uJ a full readout, {:.4g} pJ a sample; {:.4g} uJ a slot, {:.4g} pJ a "
        "sample\n"
        "             (of assumed constants, without static power)\n"
        "code         {} bits of schedule memory, {:.4g} Mbit/s, {} clocks to load\n"
        "slot         {} clocks: {}",
        hypothetical_text(rate, cost), cost.shape().cols, cost.shape().rows,
        rounded(rate.full_hz, 5), rate.full.total, rate.full.row, rounded(rate.coded_hz, 5),
        rounded(rate.min_slot_clocks, 6), rate.slowest.counts.readout_clocks, deadline_text(rate),
        rate.speedup, name_of(rate.slowest.limit), balanced_text(rate), 100 * use.rows,
        100 * use.adc, 100 * use.link, rate.full_energy_pj * 1e-6, full_sample_pj(rate, cost),
        rate.period.energy_pj / period * 1e-6, coded_sample_pj(rate),
        schedule_memory_bits(cost.schedule()), 1e-6 * code_bits_per_second(cost, rate.coded_hz),
        cost.timing().code_load_clocks, cost.budget().clocks,
        fits_slot(rate, cost) ? "each row is read in time"
                              : "too short, rows are not read in time");
}

}  // namespace stipple
