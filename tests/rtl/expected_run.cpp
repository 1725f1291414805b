#include "tests/rtl/expected_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/index.h"

namespace stipple {
namespace {

using Kind = std::vector<ChipEvent> ChipEvents::*;

struct NamedKind {
    const char* name;
    Kind kind;
};

constexpr NamedKind kKinds[] = {
    {"slot_start", &ChipEvents::slot_start},
    {"scan_start", &ChipEvents::scan_start},
    {"select", &ChipEvents::select},
    {"convert", &ChipEvents::convert},
    {"convert_end", &ChipEvents::convert_end},
    {"transfer", &ChipEvents::transfer},
    {"transfer_end", &ChipEvents::transfer_end},
    {"row_done", &ChipEvents::row_done},
};

std::uint64_t little_endian(std::span<const std::uint8_t> bytes) {
    std::uint64_t value = 0;
    for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte) value = value << 8U | *byte;
    return value;
}

}  // namespace

ExpectedRun expected_run(ReadoutCost& cost, int slots) {
    ExpectedRun run;
    ChipEvents& events = run.events;
    for (int slot = 0; slot < slots; ++slot) {
        const SlotCost it = cost.add_next();
        const SlotTimes times = cost.times(slot, it);
        events.slot_start.push_back({it.begin, 0});
        // Without another row the dark rows are not read either.
        if (times.rows.empty() || times.rows.back().load.row < 0) continue;
        run.scanned.push_back(slot);
        events.scan_start.push_back({it.scan_begin, 0});
        for (const RowTimes& row : times.rows) {
            events.select.push_back({row.select, row.load.row});
            events.convert.push_back({row.convert, row.load.row});
            events.convert_end.push_back({row.convert_end, row.load.row});
            events.transfer.push_back({row.transfer, row.load.row});
            events.transfer_end.push_back({row.transfer_end, row.load.row});
            events.row_done.push_back({row.frame_end, row.load.row});
        }
    }
    for (const NamedKind& kind : kKinds) std::ranges::sort(events.*kind.kind);
    return run;
}

std::string differences(const ChipEvents& expected, ChipEvents given) {
    std::string text;
    for (const auto& [name, kind] : kKinds) {
        const auto& wanted = expected.*kind;
        auto& had = given.*kind;
        std::ranges::sort(had);
        const auto [a, b] = std::ranges::mismatch(wanted, had);
        if (a == wanted.end() && b == had.end()) continue;
        text += fmt::format("{} {}: ", name, a - wanted.begin());
        text += a == wanted.end() ? "none" : fmt::format("row {} at {}", a->row, a->clock);
        text += b == had.end() ? ", chip none\n"
                               : fmt::format(", chip row {} at {}\n", b->row, b->clock);
    }
    return text;
}

StreamBytes read_stream_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> chars{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::uint8_t> bytes(chars.begin(), chars.end());
    const auto all = std::span(bytes);
    const auto header = static_cast<std::size_t>(little_endian(all.subspan(12, 4)));
    const auto end = static_cast<std::size_t>(little_endian(all.last(16).first(8)));
    const auto copy = [&](std::size_t from, std::size_t to) {
        const auto part = all.subspan(from, to - from);
        return std::vector<std::uint8_t>(part.begin(), part.end());
    };
    return {.header = copy(0, header),
            .packets = copy(header, end),
            .end = copy(end, bytes.size()),
            .header_crc = static_cast<std::uint32_t>(little_endian(all.subspan(header - 4, 4)))};
}

std::vector<std::uint16_t> columns_of(const SamplePacket& packet, const ExposureSchedule& schedule,
                                      FrameShape shape, int row) {
    std::vector<std::uint16_t> columns(index(shape.cols));
    if (row < 0) return columns;
    std::size_t sample = count_due(schedule, packet.slot, 0, row, shape.cols);
    for_each_readout(schedule, packet.slot, row, shape.cols,
                     [&](int col, int) { columns[index(col)] = packet.dn[sample++]; });
    return columns;
}

SequencerProgram program_for(const ExposureSchedule& schedule, const ChipParameters& size,
                             int offset) {
    const SequencerProgram small = compile_schedule(schedule);
    if (size.tile_rows % small.tile_rows != 0 || size.tile_cols % small.tile_cols != 0 ||
        small.bits_per_pixel > size.pixel_bits || small.period_slots > size.depth)
        throw InputError("chip", "the program does not fit");
    SequencerProgram program = repeated_program(small, {.tile_rows = size.tile_rows,
                                                        .tile_cols = size.tile_cols,
                                                        .bits_per_pixel = size.pixel_bits,
                                                        .pixels = {}});
    const auto last_slots = static_cast<std::ptrdiff_t>(offset * size.tile_rows * size.tile_cols);
    std::rotate(program.pixels.begin(), program.pixels.end() - last_slots, program.pixels.end());
    return program;
}

}  // namespace stipple
