#include "stream/switch_track.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/memory_limit.h"
#include "stream/crc32c.h"
#include "stream/header_codec.h"

namespace stipple {
namespace {

/// Memory of a schedule, about.
std::uint64_t bytes_of(const ExposureSchedule& schedule) {
    const std::uint64_t rows = index(schedule.tile_rows());
    const std::uint64_t period = index(schedule.period_slots());
    const double pixel_slots =
        static_cast<double>(rows * period) * static_cast<double>(schedule.tile_cols());
    const double exposures = schedule.samples_per_pixel_slot() * pixel_slots;
    return static_cast<std::uint64_t>(exposures * (sizeof(Exposure) + sizeof(DuePixel))) +
           sizeof(std::uint32_t) * (rows * period + rows * index(schedule.tile_cols()));
}

bool is_copy(const PacketHeader& packet, const PacketHeader& last) {
    return packet.switches == last.switches && packet.slot == last.slot &&
           packet.payload_crc == last.payload_crc && packet.payload_bytes == last.payload_bytes &&
           packet.flags == 0 && packet.first_row == 0 && packet.rows == 0 && packet.samples == 0;
}

}  // namespace

const DueCounts* SwitchTrack::counts() const {
    const auto& counts = taken_.empty() ? stream_.counts : taken_.back().counts;
    return counts ? &*counts : nullptr;
}

void SwitchTrack::check(const ScheduleSwitch& next) const {
    const StreamHeader& header = stream_.header;
    if (!follows_)
        throw InputError(
            where_, fmt::format("its schedule changes at slot {}; only \"stipple decode\" of one "
                                "stream, \"info\" and \"recover\" follow that",
                                next.slot));
    if (!header.sites.empty() && next.values != readout_values(header.calibration))
        throw InputError(where_,
                         fmt::format("its readout changes at slot {}, but the calibration of each "
                                     "pixel holds for that of the header; decode without it",
                                     next.slot));
    std::uint64_t bytes =
        bytes_of(next.schedule) + 2 * sizeof(std::uint64_t) * header.shape.pixels();
    for (const ScheduleSwitch& old : header.switches) bytes += bytes_of(old.schedule);
    check_memory(bytes, where_, "its schedules", input_bytes_);
}

std::optional<std::string> SwitchTrack::take(const PacketHeader& found,
                                             std::span<const std::uint8_t> payload,
                                             StreamPosition expected) {
    if (!taken_.empty() && is_copy(found, taken_.back().packet)) return std::nullopt;
    StreamHeader& header = stream_.header;
    if (auto fault = switch_fault(header, found, expected)) return fault;
    Taken taken{found, {}};
    std::optional<ScheduleSwitch> next;
    try {
        next = decode_switch(payload, header.shape, "switch",
                             {stream_.counting ? &taken.counts : nullptr, input_bytes_});
    } catch (const InputError& error) {
        return error.message().text();
    }
    next->slot = static_cast<std::int64_t>(found.slot);
    next->number = found.switches;
    check(*next);
    // Counted schedules are not those of the pixels.
    if (!stream_.counting)
        if (auto fault = joined_.fault(header, *next)) return fault;
    header.switches.push_back(std::move(*next));
    taken_.push_back(std::move(taken));
    return std::nullopt;
}

bool SwitchTrack::reach(const IndexPlace& place, const BufferedReader& file) {
    forget_after(static_cast<std::int64_t>(place.begin.slot));
    for (std::size_t i = 0; i < place.switches.size(); ++i) {
        const IndexEntry& entry = place.switches[i];
        if (entry.slot > place.begin.slot) break;
        if (index(last_switch(stream_.header)) > i) continue;
        const auto start = file.read_at(entry.offset, kPacketHeaderBytes);
        if (!start || start_of(*start, stream_.framing) != Start::kPacket) return false;
        const PacketHeader found = decode_packet_header(*start);
        if (found.kind != PacketKind::kSwitch || found.slot != entry.slot ||
            found.switches != i + 1)
            return false;
        const auto payload = file.read_at(entry.offset + kPacketHeaderBytes, found.payload_bytes);
        if (!payload || crc32c(*payload) != found.payload_crc) return false;
        if (take(found, *payload, {static_cast<std::int64_t>(entry.slot), 0})) return false;
    }
    return true;
}

void SwitchTrack::forget_after(std::int64_t slot) {
    while (!taken_.empty() && stream_.header.switches.back().slot > slot) {
        stream_.header.switches.pop_back();
        taken_.pop_back();
    }
}

}  // namespace stipple
