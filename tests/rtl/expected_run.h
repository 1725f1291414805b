#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"
#include "readout/program/sequencer_program.h"
#include "readout/timing/readout_cost.h"
#include "stream/sample_packet.h"
#include "tests/rtl/chip_run.h"

namespace stipple {

/// What the chip does in its first slots.
struct ExpectedRun {
    ChipEvents events;
    std::vector<int> scanned;  ///< the slots of which rows are read
};

/// By ReadoutCost. Precondition: nothing was added to it yet.
[[nodiscard]] ExpectedRun expected_run(ReadoutCost& cost, int slots);

/// Differences in words, one for each kind of event; empty if there are none.
[[nodiscard]] std::string differences(const ChipEvents& expected, ChipEvents given);

/// The bytes of a .stipple file: header, packets of samples, index and end marker.
struct StreamBytes {
    std::vector<std::uint8_t> header, packets, end;
    std::uint32_t header_crc = 0;
};
[[nodiscard]] StreamBytes read_stream_bytes(const std::filesystem::path& file);

/// The DN of all columns of a row from a packet of the whole slot; columns that are not due have 0.
[[nodiscard]] std::vector<std::uint16_t> columns_of(const SamplePacket& packet,
                                                    const ExposureSchedule& schedule,
                                                    FrameShape shape, int row);

/// The program of `schedule` for a chip whose tile and bits per pixel may be larger: the tile is
/// repeated, and what the chip has more bits for is said. It begins `offset` slots earlier.
/// \throws InputError if the tile does not divide that of the chip or there are too many slots or
/// bits.
[[nodiscard]] SequencerProgram program_for(const ExposureSchedule& schedule,
                                           const ChipParameters& size, int offset = 0);

}  // namespace stipple
