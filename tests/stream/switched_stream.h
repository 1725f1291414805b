#pragma once

#include <string>
#include <utility>
#include <vector>

#include "stream/bit_packing.h"
#include "stream/schedule_switch.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {

/// A stream of three schedules: explicit with closed slots, random, and the first one again. The
/// first switch changes only the schedule.
struct SwitchedStream {
    StreamHeader header;  ///< with its switches
    std::vector<SamplePacket> packets;
    StreamBytes stream;            ///< `begins` has switch packets, too
    std::vector<std::size_t> own;  ///< which of `begins` are switch packets
};

/// Closed slots within and between exposures, and a pixel that is never read.
inline ExposureSchedule gapped_schedule() {
    return {1, 3, 5, {0, 2, 2, 3}, {{0, 0b101}, {4, 0b1}, {3, 0b1011}}};
}

inline StreamHeader switching_header(FrameShape shape = {4, 6, 1}) {
    StreamHeader header{shape, 5000, {}, gapped_schedule(), {}, "gapped", "seed = 1\n"};
    header.calibration.bit_depth = 10;
    header.may_switch = true;
    return header;
}

inline ScheduleSwitch switch_to(const StreamHeader& header) {
    return {.schedule = header.schedule,
            .source = header.schedule_source,
            .name = header.schedule_name,
            .values = readout_values(header.calibration)};
}

/// As many random DN as are due by the switches of `header`.
inline SamplePacket switched_packet(const StreamHeader& header, std::int64_t slot, int first_row,
                                    int rows) {
    const SchedulePart part = schedule_at(header, slot);
    StreamHeader alone = header;
    alone.schedule = *part.schedule;
    SamplePacket packet = random_packet(alone, readout_slot(part, slot), first_row, rows);
    packet.slot = slot;
    return packet;
}

/// Slots 0..19 in two bands each, with switches at slots 6 and 13.
inline SwitchedStream switched_stream() {
    const TemporaryFolder folder;
    SwitchedStream result{switching_header(), {}, {}, {}};
    const FrameShape shape = result.header.shape;
    StreamWriter writer(folder / "clip.stipple", result.header);
    auto& begins = result.stream.begins;
    std::uint64_t end = writer.bytes_written();
    for (int slot = 0; slot < 20; ++slot) {
        if (slot == 6 || slot == 13) {
            ScheduleSwitch next = switch_to(slot == 6 ? random_header(shape, 5) : result.header);
            next.slot = slot;
            next.number = slot == 6 ? 1 : 2;
            if (slot == 13) next.values.gain_e_per_dn = 100;
            if (slot == 13) next.values.rounding = Rounding::kFloor;
            if (slot == 6) next.values = readout_values(result.header.calibration);
            writer.switch_schedule(next);
            result.header.switches.push_back(next);
            result.own.push_back(begins.size());
            begins.push_back(std::exchange(end, writer.bytes_written()));
        }
        for (const int row : {0, 2}) {
            result.packets.push_back(switched_packet(result.header, slot, row, 2));
            begins.push_back(end);
            writer.write(result.packets.back());
            end = begins.back() + kPacketHeaderBytes +
                  packed_bytes(result.packets.back().dn.size(), 10);
        }
        if (end == writer.bytes_written()) continue;
        result.own.push_back(begins.size());  // the copy
        begins.push_back(std::exchange(end, writer.bytes_written()));
    }
    begins.push_back(end);
    writer.finish();
    result.stream.bytes = read_text(folder / "clip.stipple");
    begins.push_back(result.stream.bytes.size() - kEndMarkerBytes);
    begins.push_back(result.stream.bytes.size());
    return result;
}

}  // namespace stipple
