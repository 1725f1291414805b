#pragma once

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/philox.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"

namespace stipple {

/// A tile of 2 x 3 pixels with all that a schedule may have: an exposure that wraps around, one
/// with a closed slot in it, two that interleave, and a pixel that is never read.
inline ExposureSchedule varied_schedule() {
    return {2,
            3,
            5,
            {0, 1, 3, 4, 6, 6, 11},
            {{3, 0b1111},  // (0, 0)
             {0, 0b1},
             {1, 0b111},   // (0, 1)
             {1, 0b1011},  // (0, 2)
             {0, 0b101},
             {1, 0b101},  // (1, 0)
             {0, 1},
             {1, 1},
             {2, 1},
             {3, 1},
             {4, 1}}};  // (1, 2)
}

inline StreamHeader varied_header(FrameShape shape = {4, 8, 1}, int bit_depth = 10) {
    StreamHeader header{shape, 5000, {}, varied_schedule(), {}, "varied", ""};
    header.calibration.bit_depth = bit_depth;
    header.provenance = "seed = 1\nfootage = \"Gänge\"\n";
    return header;
}

/// The same exposures with a weight for each open slot, all sixteenths.
inline StreamHeader weighted_header() {
    StreamHeader header = varied_header({4, 6, 1});
    ExposureSchedule& schedule = header.schedule;
    std::vector<float> weights(5 * 6, 0.0F);
    for (unsigned pixel = 0; pixel < 6; ++pixel)
        for (const Exposure& e :
             schedule.exposures(static_cast<int>(pixel / 3), static_cast<int>(pixel % 3)))
            for (unsigned i = 0; i < 64; ++i)
                if ((e.open_slots >> i & 1U) != 0)
                    weights[(e.first_slot + i) % 5 * 6 + pixel] =
                        static_cast<float>(1 + (e.first_slot + 5 * i + pixel) % 20) / 16;
    schedule.set_weights(std::move(weights));
    return header;
}

inline StreamHeader random_header(FrameShape shape, std::uint64_t seed) {
    const std::vector<int> lengths(std::begin(kPaperExposureSlots), std::end(kPaperExposureSlots));
    return {shape,
            5000,
            {},
            random_schedule(shape.rows, shape.cols, lengths, seed),
            {ScheduleSource::Kind::kRandom, lengths, seed},
            "random",
            ""};
}

/// As many random DN as are due in these rows.
inline SamplePacket random_packet(const StreamHeader& header, std::int64_t slot, int first_row,
                                  int rows) {
    SamplePacket packet{slot, first_row, rows, 0, {}};
    const auto count = count_due(header.schedule, slot, first_row, rows, header.shape.cols) *
                       static_cast<std::size_t>(header.shape.planes);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto word = philox4x32(
            {i, static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(first_row), 0}, 3)[0];
        packet.dn.push_back(
            static_cast<std::uint16_t>(word >> (32 - header.calibration.bit_depth)));
    }
    return packet;
}

/// `slots` slots, each in bands of `band_rows` rows.
inline std::vector<SamplePacket> random_packets(const StreamHeader& header, int slots,
                                                int band_rows) {
    std::vector<SamplePacket> packets;
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < header.shape.rows; row += band_rows)
            packets.push_back(
                random_packet(header, slot, row, std::min(band_rows, header.shape.rows - row)));
    return packets;
}

inline void write_stream(const std::filesystem::path& file, const StreamHeader& header,
                         const std::vector<SamplePacket>& packets) {
    StreamWriter writer(file, header);
    for (const SamplePacket& packet : packets) writer.write(packet);
    writer.finish();
}

inline std::vector<SamplePacket> read_packets(StreamReader& reader) {
    std::vector<SamplePacket> packets;
    for (SamplePacket packet; reader.next(packet);) packets.push_back(packet);
    return packets;
}

}  // namespace stipple
