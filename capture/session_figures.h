#pragma once

#include <cstddef>

#include "capture/capture_session.h"

namespace stipple {

// Figures of a capture session under the names of docs/outputs.md (`capture record`, `capture
// live`). The functions `visit_...` call `add(name, number)` for each.

/// The key `lost`: missing frames by their cause.
template <typename Add>
void visit_lost_figures(const SessionTotals& totals, const Add& add) {
    for (std::size_t i = 1; i < kGapCauses.size(); ++i)
        add(kGapCauses[i].name.data(), totals.lost[i]);
}

/// The key `transport`.
template <typename Add>
void visit_transport_figures(const TransportCounts& counts, const Add& add) {
    add("underruns", counts.underruns);
    add("packets_resent", counts.packets_resent);
    add("packets_missing", counts.packets_missing);
    add("socket_drops", counts.socket_drops);
    add("link_faults", counts.link_faults);
    add("size_mismatches", counts.size_mismatches);
}

}  // namespace stipple
