#include "study/report/stream_samples.h"

#include <cstddef>
#include <nlohmann/json.hpp>

#include "core/config.h"
#include "core/error.h"
#include "readout/provenance.h"
#include "readout/timing/readout_cost.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

ordered_json cost_of(const StreamHeader& header, const ReadoutTiming& timing, std::int64_t slots) {
    ReadoutCost cost(timing, header.schedule, header.shape,
                     {slot_clocks(timing, header.slot_us), OverrunPolicy::kStretch});
    ordered_json readout = ordered_json::array(), convert = readout, link = readout, bits = readout,
                 limit = readout;
    for (std::int64_t slot = 0; slot < slots; ++slot) {
        const SlotCost& of_slot = cost.add_next();
        readout.push_back(of_slot.counts.readout_clocks);
        convert.push_back(of_slot.counts.convert_clocks);
        link.push_back(of_slot.counts.link_clocks);
        bits.push_back(of_slot.counts.bits);
        limit.push_back(name_of(of_slot.limit));
    }
    return {{"clock_hz", timing.clock_hz},
            {"slot_clocks", cost.budget().clocks},
            {"readout", readout},
            {"convert", convert},
            {"link", link},
            {"link_bits", bits},
            {"limit", limit}};
}

ordered_json lanes_of(const StreamHeader& header, const ReadoutTiming& timing, std::int64_t slot) {
    ReadoutCost cost(timing, header.schedule, header.shape,
                     {slot_clocks(timing, header.slot_us), OverrunPolicy::kStretch});
    cost.begin_at(slot);
    const SlotCost& of_slot = cost.add_next();
    const SlotTimes times = cost.times(slot, of_slot);
    ordered_json rows = ordered_json::array();
    for (const RowTimes& row : times.rows)
        rows.push_back({row.load.row, row.select - of_slot.begin, row.convert - of_slot.begin,
                        row.convert_end - of_slot.begin, row.transfer - of_slot.begin,
                        row.transfer_end - of_slot.begin});
    return {{"clock_hz", timing.clock_hz}, {"slot_clocks", of_slot.clocks}, {"rows", rows}};
}

/// What `make` makes of the timing that the provenance tells; else null.
template <typename Make>
ordered_json with_timing(const StreamHeader& header, const Make& make) {
    try {
        Config config(timing_settings(header.provenance));
        if (const auto timing = read_timing(config, header.calibration.bit_depth))
            return make(*timing);
    } catch (const InputError&) {
        // A text for people: it need not tell a timing, nor one of this schedule.
    }
    return nullptr;
}

}  // namespace

ordered_json readout_json(const StreamHeader& header, std::int64_t slots) {
    return with_timing(header,
                       [&](const ReadoutTiming& timing) { return cost_of(header, timing, slots); });
}

ordered_json readout_lanes_json(const StreamHeader& header, std::int64_t slot) {
    return with_timing(header,
                       [&](const ReadoutTiming& timing) { return lanes_of(header, timing, slot); });
}

void StreamLoads::add(const SamplePacket& packet) {
    const auto slot = static_cast<std::size_t>(packet.slot);
    if (slot >= samples_.size()) {
        samples_.resize(slot + 1);
        flags_.resize(slot + 1);
    }
    samples_[slot] += packet.dn.size();
    flags_[slot] |= packet.flags;
}

ordered_json StreamLoads::json() const {
    ordered_json due = ordered_json::array(), bits = due, overrun = due, dropped = due;
    const auto planes = static_cast<std::uint64_t>(header_.shape.planes);
    const auto depth = static_cast<std::uint64_t>(header_.calibration.bit_depth);
    for (std::size_t slot = 0; slot < samples_.size(); ++slot) {
        due.push_back(planes * count_due(header_.schedule, static_cast<std::int64_t>(slot), 0,
                                         header_.shape.rows, header_.shape.cols));
        bits.push_back(depth * samples_[slot]);
        overrun.push_back((flags_[slot] & SamplePacket::kOverrun) != 0);
        dropped.push_back((flags_[slot] & SamplePacket::kDropped) != 0);
    }
    return {{"samples", samples_},
            {"due", due},
            {"payload_bits", bits},
            {"overrun", overrun},
            {"dropped", dropped},
            {"full_bits", depth * header_.shape.sites()},
            {"clocks", readout_json(header_, slots())}};
}

}  // namespace stipple
