#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "readout/program/sequencer_program.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"

namespace stipple {

// Figures of a readout under the names and in the units of docs/outputs.md. The functions
// `visit_...` call `add(name, value)` for each; values are numbers, texts, true or false, or
// std::optional.

/// Fractions of rows, ADC time and link time that are used, 0..1.
struct Utilisation {
    double rows = 0;
    double adc = 0;
    double link = 0;
};

/// Of the slots that `cost` has added up. NaN without slots.
[[nodiscard]] Utilisation utilisation(const ReadoutCost& cost);
/// Of a steady period; `cost` is that of the same schedule and window.
[[nodiscard]] Utilisation utilisation(const ReadoutRate& rate, const ReadoutCost& cost);

/// Seconds on the sensor's clock of the slots that `cost` has added up.
[[nodiscard]] double seconds_of(const ReadoutCost& cost);

/// Rate of the exposure code, one bit per pixel and slot, in bits/s.
[[nodiscard]] double code_bits_per_second(const ReadoutCost& cost, double slots_hz);

/// Energy per sample of a full readout, and of a coded one in its steady period, in pJ.
[[nodiscard]] double full_sample_pj(const ReadoutRate& rate, const ReadoutCost& cost);
[[nodiscard]] double coded_sample_pj(const ReadoutRate& rate);

/// True if slots of the budget are long enough for all readouts to meet their deadlines.
[[nodiscard]] bool fits_slot(const ReadoutRate& rate, const ReadoutCost& cost);

/// The key `readout` of `emulate`. `light_throughput`: of schedule and filters, 0..1.
template <typename Add>
void visit_cost_figures(const ReadoutCost& cost, double light_throughput, const Add& add) {
    const ReadoutCounts& totals = cost.totals();
    const double seconds = seconds_of(cost);
    const double slots_hz = static_cast<double>(cost.slots()) / seconds;
    const Utilisation use = utilisation(cost);
    add("overrun_policy", name_of(cost.budget().policy));
    add("slot_clocks", cost.budget().clocks);
    add("clocks", cost.clocks());
    add("seconds", seconds);
    add("slots_hz", slots_hz);
    add("overrun_slots", cost.overruns());
    add("dropped_samples", totals.dropped_samples);
    add("readout_clocks", totals.readout_clocks);
    add("rows_read", totals.rows);
    add("conversions", totals.conversions);
    add("transferred_samples", totals.transferred);
    add("link_bits", totals.bits);
    add("row_utilisation", use.rows);
    add("adc_utilisation", use.adc);
    add("link_utilisation", use.link);
    add("energy_uj", totals.energy_pj * 1e-6);
    add("sample_energy_pj", totals.energy_pj / static_cast<double>(totals.samples));
    add("light_throughput", light_throughput);
    add("schedule_memory_bits", schedule_memory_bits(cost.schedule()));
    add("code_load_bits_per_second", code_bits_per_second(cost, slots_hz));
}

/// Rates of the keys of `timing`: full and coded readout, and the slots that limit them.
template <typename Add>
void visit_rate_figures(const ReadoutRate& rate, const ReadoutCost& cost, const Add& add) {
    const auto seconds = [&](std::int64_t clocks) {
        return static_cast<double>(clocks) / static_cast<double>(cost.timing().clock_hz);
    };
    const std::string& hypothetical = cost.timing().hypothetical;
    add("exposes_while_reading", cost.timing().exposes_while_reading);
    add("hypothetical", hypothetical.empty() ? std::nullopt : std::optional(hypothetical));
    add("rows", cost.shape().rows);
    add("cols", cost.shape().cols);
    add("full_readout_hz", rate.full_hz);
    add("coded_readout_hz", rate.coded_hz);
    add("speedup", rate.speedup);
    add("limited_by", name_of(rate.slowest.limit));
    add("frame_clocks", rate.full.total);
    add("frame_time_s", seconds(rate.full.total));
    add("row_clocks", rate.full.row);
    add("full_settle_clocks", rate.full.settle);
    add("slowest_settle_clocks", rate.slowest.settle_clocks);
    add("balanced_speedup", rate.balanced_speedup);
    add("balanced_row_clocks", rate.balanced.row);
    add("min_slot_clocks", rate.min_slot_clocks);
    add("slowest_readout_clocks", rate.slowest.counts.readout_clocks);
    add("slowest_readout_time_s", seconds(rate.slowest.counts.readout_clocks));
    add("slowest_phase", rate.slowest_phase);
    add("deadline_slots", rate.deadline_slots);
    add("mean_slot_clocks", rate.mean_slot_clocks);
    add("mean_coded_readout_hz", rate.mean_coded_hz);
    add("slot_clocks", cost.budget().clocks);
    add("fits_slot", fits_slot(rate, cost));
}

/// Cost of the keys of `timing`: of a full readout and of a mean slot of the steady period.
template <typename Add>
void visit_period_figures(const ReadoutRate& rate, const ReadoutCost& cost, const Add& add) {
    const ReadoutCounts& period = rate.period;
    const auto slots = static_cast<double>(cost.schedule().period_slots());
    const Utilisation use = utilisation(rate, cost);
    add("row_utilisation", use.rows);
    add("adc_utilisation", use.adc);
    add("link_utilisation", use.link);
    add("samples_per_slot", static_cast<double>(period.samples) / slots);
    add("transferred_per_slot", static_cast<double>(period.transferred) / slots);
    add("link_bits_per_second", static_cast<double>(period.bits) / slots * rate.coded_hz);
    add("full_energy_uj", rate.full_energy_pj * 1e-6);
    add("slot_energy_uj", period.energy_pj / slots * 1e-6);
    add("full_sample_energy_pj", full_sample_pj(rate, cost));
    add("slot_sample_energy_pj", coded_sample_pj(rate));
    add("schedule_memory_bits", schedule_memory_bits(cost.schedule()));
    add("code_load_clocks", cost.timing().code_load_clocks);
    add("code_load_bits_per_second", code_bits_per_second(cost, rate.coded_hz));
}

}  // namespace stipple
