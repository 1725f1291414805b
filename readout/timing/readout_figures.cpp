#include "readout/timing/readout_figures.h"

namespace stipple {
namespace {

Utilisation utilisation_of(const ReadoutCounts& counts, double clocks, double slots, int all_rows) {
    return {static_cast<double>(counts.rows) / (slots * all_rows),
            static_cast<double>(counts.convert_clocks) / clocks,
            static_cast<double>(counts.link_clocks) / clocks};
}

int all_rows(const ReadoutCost& cost) {
    return cost.shape().rows + cost.timing().dark_rows;
}

}  // namespace

Utilisation utilisation(const ReadoutCost& cost) {
    return utilisation_of(cost.totals(), static_cast<double>(cost.clocks()),
                          static_cast<double>(cost.slots()), all_rows(cost));
}

Utilisation utilisation(const ReadoutRate& rate, const ReadoutCost& cost) {
    const int period = cost.schedule().period_slots();
    return utilisation_of(rate.period, rate.mean_slot_clocks * period, period, all_rows(cost));
}

double seconds_of(const ReadoutCost& cost) {
    return static_cast<double>(cost.clocks()) / static_cast<double>(cost.timing().clock_hz);
}

double code_bits_per_second(const ReadoutCost& cost, double slots_hz) {
    return static_cast<double>(cost.shape().pixels()) * slots_hz;
}

double full_sample_pj(const ReadoutRate& rate, const ReadoutCost& cost) {
    return rate.full_energy_pj / static_cast<double>(cost.shape().sites());
}

double coded_sample_pj(const ReadoutRate& rate) {
    return rate.period.energy_pj / static_cast<double>(rate.period.samples);
}

bool fits_slot(const ReadoutRate& rate, const ReadoutCost& cost) {
    return rate.min_slot_clocks <= static_cast<double>(cost.budget().clocks);
}

}  // namespace stipple
