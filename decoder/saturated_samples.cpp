#include "decoder/saturated_samples.h"

#include <algorithm>

#include "core/exposure_schedule.h"

namespace stipple {

void SaturatedSamples::add(const SamplePacket& packet) {
    if (packet.dn.empty()) return;  // dropped
    const std::uint16_t* dn = packet.dn.data();
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        for_each_readout(header_.schedule, packet.slot, row, header_.shape.cols, [&](int col, int) {
            for (int plane = 0; plane < header_.shape.planes; ++plane)
                if (responses_.at(plane, row, col).saturated(*dn++)) ++saturated_;
        });
    zeros_ += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 0));
    samples_ += packet.dn.size();
}

}  // namespace stipple
