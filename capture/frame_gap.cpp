#include "capture/frame_gap.h"

#include <algorithm>
#include <numeric>

namespace stipple {

std::uint64_t FrameGap::total() const {
    return std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
}

GapCause FrameGap::cause() const {
    const auto* const most = std::max_element(lost.begin(), lost.end());
    return *most == 0 ? GapCause::kNone : static_cast<GapCause>(most - lost.begin());
}

GapCause cause_of(const TransportCounts& before, const TransportCounts& after,
                  bool incomplete_frames) {
    if (after.underruns > before.underruns) return GapCause::kHostUnderrun;
    if (after.socket_drops > before.socket_drops || after.link_faults > before.link_faults)
        return GapCause::kTransport;
    if (after.packets_missing > before.packets_missing && !incomplete_frames)
        return GapCause::kTransport;
    return GapCause::kDevice;
}

}  // namespace stipple
