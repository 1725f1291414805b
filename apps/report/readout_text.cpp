#include "apps/report/readout_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/report/number_text.h"
#include "readout/program/sequencer_program.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

double seconds(const ReadoutTiming& timing, double clocks) {
    return clocks / static_cast<double>(timing.clock_hz);
}

/// Shares of rows, ADCs and link in use over `clocks` and `slots`.
struct Utilisation {
    double rows;
    double adc;
    double link;
};

Utilisation utilisation(const ReadoutCounts& counts, double clocks, double slots, int all_rows) {
    return {static_cast<double>(counts.rows) / (slots * all_rows),
            static_cast<double>(counts.convert_clocks) / clocks,
            static_cast<double>(counts.link_clocks) / clocks};
}

Utilisation utilisation(const ReadoutCost& cost) {
    return utilisation(cost.totals(), static_cast<double>(cost.clocks()),
                       static_cast<double>(cost.slots()),
                       cost.shape().rows + cost.timing().dark_rows);
}

Utilisation utilisation(const ReadoutRate& rate, const ReadoutCost& cost) {
    const int period = cost.schedule().period_slots();
    return utilisation(rate.period, rate.mean_slot_clocks * period, period,
                       cost.shape().rows + cost.timing().dark_rows);
}

/// The exposure code: a bit per pixel and slot.
double code_bits_per_second(const ReadoutCost& cost, double slots_per_second) {
    return static_cast<double>(cost.shape().pixels()) * slots_per_second;
}

const char* name_of(OverrunPolicy policy) {
    return policy == OverrunPolicy::kDrop ? "drop" : "stretch";
}

double full_sample_pj(const ReadoutRate& rate, const ReadoutCost& cost) {
    return rate.full_energy_pj / static_cast<double>(cost.shape().sites());
}

double slot_sample_pj(const ReadoutRate& rate) {
    return rate.period.energy_pj / static_cast<double>(rate.period.samples);
}

/// On a chip that is not for sale, with the settling that it takes, a line each; else empty.
std::string hypothetical_text(const ReadoutRate& rate, const ReadoutCost& cost) {
    const ReadoutTiming& timing = cost.timing();
    if (timing.hypothetical.empty()) return {};
    std::string text = fmt::format("hypothetical {}", timing.hypothetical);
    if (!timing.settle_clocks.empty())
        text += fmt::format("; rows settle for {} clocks in full, {} in the slowest slot",
                            rate.full.settle, rate.slowest.settle_clocks);
    for (auto at = text.find("; "); at != std::string::npos; at = text.find("; "))
        text.replace(at, 2, ";\n             ");
    return text + '\n';
}

bool fits(const ReadoutRate& rate, const ReadoutCost& cost) {
    return rate.slowest.clocks <= cost.budget().clocks;
}

}  // namespace

ordered_json readout_json(const ReadoutCost& cost, double light_throughput) {
    const ReadoutCounts& totals = cost.totals();
    const double span_s = seconds(cost.timing(), static_cast<double>(cost.clocks()));
    const double slots_hz = static_cast<double>(cost.slots()) / span_s;
    const Utilisation use = utilisation(cost);
    return {{"overrun_policy", name_of(cost.budget().policy)},
            {"slot_clocks", cost.budget().clocks},
            {"clocks", cost.clocks()},
            {"seconds", span_s},
            {"sensor_slots_hz", slots_hz},
            {"overrun_slots", cost.overruns()},
            {"dropped_samples", totals.dropped_samples},
            {"readout_clocks", totals.readout_clocks},
            {"rows_read", totals.rows},
            {"conversions", totals.conversions},
            {"transferred_samples", totals.transferred},
            {"link_bits", totals.bits},
            {"row_utilisation", use.rows},
            {"adc_utilisation", use.adc},
            {"link_utilisation", use.link},
            {"energy_uj", totals.energy_pj * 1e-6},
            {"sample_energy_pj", totals.energy_pj / static_cast<double>(totals.samples)},
            {"light_throughput", light_throughput},
            {"schedule_memory_bits", schedule_memory_bits(cost.schedule())},
            {"code_load_bits_per_second", code_bits_per_second(cost, slots_hz)}};
}

std::string readout_text(const ReadoutCost& cost) {
    const ReadoutCounts& totals = cost.totals();
    const double span_s = seconds(cost.timing(), static_cast<double>(cost.clocks()));
    const Utilisation use = utilisation(cost);
    std::string text = fmt::format(
        "readout      {:.5g} slots/s of the sensor, {:.1f} % of the rows read, ADCs {:.1f} %, link "
        "{:.1f} % busy,\n"
        "             {} bits over the link, {:.4g} uJ; schedule memory {} bits, code {:.4g} "
        "Mbit/s",
        static_cast<double>(cost.slots()) / span_s, 100 * use.rows, 100 * use.adc, 100 * use.link,
        totals.bits, totals.energy_pj * 1e-6, schedule_memory_bits(cost.schedule()),
        1e-6 * code_bits_per_second(cost, static_cast<double>(cost.slots()) / span_s));
    if (cost.overruns() > 0)
        text += fmt::format(
            "\noverruns     {} longer than {} clocks: {}", counted(cost.overruns(), "slot"),
            cost.budget().clocks,
            cost.budget().policy == OverrunPolicy::kDrop
                ? fmt::format("{} samples dropped", totals.dropped_samples)
                : "they are stretched; \"--overrun drop\" keeps the rate and gives up rows");
    return text;
}

ordered_json rate_json(const ReadoutRate& rate, const ReadoutCost& cost) {
    const ReadoutTiming& timing = cost.timing();
    const Utilisation use = utilisation(rate, cost);
    const auto period = static_cast<double>(cost.schedule().period_slots());
    return {
        {"hypothetical",
         timing.hypothetical.empty() ? ordered_json(nullptr) : ordered_json(timing.hypothetical)},
        {"rows", cost.shape().rows},
        {"cols", cost.shape().cols},
        {"full_readout_hz", rate.full_hz},
        {"coded_readout_hz", rate.coded_hz},
        {"speedup", rate.speedup},
        {"limited_by", name_of(rate.slowest.limit)},
        {"frame_clocks", rate.full.total},
        {"frame_time_s", seconds(timing, static_cast<double>(rate.full.total))},
        {"row_clocks", rate.full.row},
        {"full_settle_clocks", rate.full.settle},
        {"slowest_settle_clocks", rate.slowest.settle_clocks},
        {"balanced_speedup", rate.balanced_speedup},
        {"balanced_row_clocks", rate.even.row},
        {"slowest_slot_clocks", rate.slowest.clocks},
        {"slowest_slot_time_s", seconds(timing, static_cast<double>(rate.slowest.clocks))},
        {"slowest_phase", rate.slowest_phase},
        {"mean_slot_clocks", rate.mean_slot_clocks},
        {"mean_coded_readout_hz", rate.mean_coded_hz},
        {"slot_clocks", cost.budget().clocks},
        {"fits_slot", fits(rate, cost)},
        {"row_utilisation", use.rows},
        {"adc_utilisation", use.adc},
        {"link_utilisation", use.link},
        {"samples_per_slot", static_cast<double>(rate.period.samples) / period},
        {"transferred_per_slot", static_cast<double>(rate.period.transferred) / period},
        {"link_bits_per_second", static_cast<double>(rate.period.bits) / period * rate.coded_hz},
        {"full_energy_uj", rate.full_energy_pj * 1e-6},
        {"slot_energy_uj", rate.period.energy_pj / period * 1e-6},
        {"full_sample_energy_pj", full_sample_pj(rate, cost)},
        {"slot_sample_energy_pj", slot_sample_pj(rate)},
        {"schedule_memory_bits", schedule_memory_bits(cost.schedule())},
        {"code_load_clocks", timing.code_load_clocks},
        {"code_load_bits_per_second", code_bits_per_second(cost, rate.coded_hz)}};
}

std::string rate_text(const ReadoutRate& rate, const ReadoutCost& cost) {
    const Utilisation use = utilisation(rate, cost);
    const double period = cost.schedule().period_slots();
    return fmt::format(
        "{}window       {} x {} (width x height)\n"
        "full         {:.5g} readouts/s: {} clocks, {} a row\n"
        "coded        {:.5g} slots/s: {} clocks in the slowest slot, {:.6g} on average\n"
        "speed-up     {:.3f}, limited by {}; {:.3f} if the load were balanced over the rows\n"
        "in use       rows {:.1f} %, ADCs {:.1f} %, link {:.1f} %\n"
        "energy       {:.4g} uJ a full readout, {:.4g} pJ a sample; {:.4g} uJ a slot, {:.4g} pJ a "
        "sample\n"
        "             (of assumed constants, without static power)\n"
        "code         {} bits of schedule memory, {:.4g} Mbit/s, {} clocks to load\n"
        "slot         {} clocks: the readout {}",
        hypothetical_text(rate, cost), cost.shape().cols, cost.shape().rows, rate.full_hz,
        rate.full.total, rate.full.row, rate.coded_hz, rate.slowest.clocks, rate.mean_slot_clocks,
        rate.speedup, name_of(rate.slowest.limit), rate.balanced_speedup, 100 * use.rows,
        100 * use.adc, 100 * use.link, rate.full_energy_pj * 1e-6, full_sample_pj(rate, cost),
        rate.period.energy_pj / period * 1e-6, slot_sample_pj(rate),
        schedule_memory_bits(cost.schedule()), 1e-6 * code_bits_per_second(cost, rate.coded_hz),
        cost.timing().code_load_clocks, cost.budget().clocks,
        fits(rate, cost) ? "fits" : "does not fit");
}

}  // namespace stipple
