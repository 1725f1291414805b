#include "readout/program/sequencer_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/index.h"

namespace stipple {
namespace {

/// A tile pixel in one repetition of the schedule's period.
struct PixelPeriod {
    int row;
    int col;
    int repetition;
};

/// Writes the exposures that begin in this repetition.
void write_pixel(const ExposureSchedule& schedule, const PixelPeriod& where,
                 SequencerProgram& program) {
    const auto exposures = schedule.exposures(where.row, where.col);
    const auto bits_in = [&](std::int64_t slot) -> std::uint8_t& {
        const auto line =
            index(static_cast<int>(slot % program.period_slots)) * index(program.tile_rows) +
            index(where.row);
        return program.pixels[line * index(program.tile_cols) + index(where.col)];
    };
    for (std::size_t i = 0; i < exposures.size(); ++i) {
        const Exposure& e = exposures[i];
        const std::int64_t begin =
            e.first_slot + std::int64_t{where.repetition} * schedule.period_slots();
        const bool second = schedule.store(where.row, where.col, i, where.repetition) == 1;
        const unsigned open = SequencerProgram::kOpen | (second ? SequencerProgram::kStore : 0U);
        for (int age = 0; age < e.span_slots(); ++age)
            if ((e.open_slots >> index(age) & 1U) != 0)
                bits_in(begin + age) = static_cast<std::uint8_t>(open);
        bits_in(begin + e.span_slots() - 1) |= SequencerProgram::kRead;
    }
}

/// The exposures of one pixel and store, found by following its bits from one reading to the next.
class ExposureFinder {
  public:
    ExposureFinder(const SequencerProgram& program, const std::string& where)
        : program_(program), where_(where) {}

    /// Appends the exposures of tile pixel (row, col) in `store` (0 or kStore).
    void find(int row, int col, unsigned store, std::vector<Exposure>& found) const {
        const auto fail = [&](int slot, std::string_view problem) {
            throw InputError(where_, fmt::format("pixel ({}, {}) slot {}: {}", row, col,
                                                 slot % program_.period_slots, problem));
        };
        int last_reading = -1;
        for (int slot = 0; slot < program_.period_slots; ++slot) {
            const unsigned bits = at(slot, row, col);
            if ((bits & SequencerProgram::kRead) != 0 && (bits & SequencerProgram::kOpen) == 0)
                fail(slot, "is read while the pixel is closed");
            if (is_read(bits, store)) last_reading = slot;
        }
        int begin = -1;  // of the exposure at work, in slots that count on through two periods
        for (int slot = last_reading + 1; slot <= last_reading + program_.period_slots; ++slot) {
            const unsigned bits = at(slot % program_.period_slots, row, col);
            if (!is_open(bits, store)) continue;
            if (last_reading < 0) fail(slot, "collects light that is never read");
            if (begin < 0) begin = slot;
            if (slot - begin >= 64) fail(begin, "an exposure of more than 64 slots begins");
            if (!is_read(bits, store)) continue;
            found.push_back(exposure(row, col, store, {begin, slot}));
            begin = -1;
        }
    }

  private:
    struct Span {
        int first;
        int last;
    };

    [[nodiscard]] unsigned at(int slot, int row, int col) const {
        const auto line = index(slot) * index(program_.tile_rows) + index(row);
        const unsigned bits = program_.pixels[line * index(program_.tile_cols) + index(col)];
        return program_.bits_per_pixel == 1 ? bits | SequencerProgram::kOpen : bits;
    }
    [[nodiscard]] static bool is_open(unsigned bits, unsigned store) {
        return (bits & SequencerProgram::kOpen) != 0 && (bits & SequencerProgram::kStore) == store;
    }
    [[nodiscard]] static bool is_read(unsigned bits, unsigned store) {
        return is_open(bits, store) && (bits & SequencerProgram::kRead) != 0;
    }

    [[nodiscard]] Exposure exposure(int row, int col, unsigned store, Span span) const {
        std::uint64_t open_slots = 0;
        for (int slot = span.first; slot <= span.last; ++slot)
            if (is_open(at(slot % program_.period_slots, row, col), store))
                open_slots |= std::uint64_t{1} << static_cast<unsigned>(slot - span.first);
        return {static_cast<std::uint32_t>(span.first % program_.period_slots), open_slots};
    }

    const SequencerProgram& program_;
    const std::string& where_;
};

}  // namespace

bool stores_alternate(const ExposureSchedule& schedule) {
    if (!schedule.interleaved()) return false;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (std::size_t i = 0; i < schedule.exposures(row, col).size(); ++i)
                if (schedule.store(row, col, i, 0) != schedule.store(row, col, i, 1)) return true;
    return false;
}

int program_bits_per_pixel(const ExposureSchedule& schedule) {
    if (schedule.interleaved()) return 3;
    return schedule.gapless() ? 1 : 2;
}

std::uint64_t schedule_memory_bits(const ExposureSchedule& schedule) {
    return index(program_bits_per_pixel(schedule)) * index(schedule.tile_rows()) *
           index(schedule.tile_cols()) * index(schedule.period_slots());
}

SequencerProgram compile_schedule(const ExposureSchedule& schedule) {
    if (schedule.weighted())
        throw InputError("sequencer program",
                         "weights are of a grey mask before the chip; a sequencer has none");
    if (schedule.charge_stores() > 2)
        throw InputError("sequencer program",
                         fmt::format("the schedule needs {} charge stores per pixel; a program "
                                     "knows two",
                                     schedule.charge_stores()));
    const int repetitions = stores_alternate(schedule) ? 2 : 1;
    SequencerProgram program{.tile_rows = schedule.tile_rows(),
                             .tile_cols = schedule.tile_cols(),
                             .period_slots = schedule.period_slots() * repetitions,
                             .bits_per_pixel = program_bits_per_pixel(schedule),
                             .pixels = {}};
    program.pixels.resize(index(program.tile_rows) * index(program.tile_cols) *
                          index(program.period_slots));
    for (int repetition = 0; repetition < repetitions; ++repetition)
        for (int row = 0; row < program.tile_rows; ++row)
            for (int col = 0; col < program.tile_cols; ++col)
                write_pixel(schedule, {row, col, repetition}, program);
    const auto mask = static_cast<std::uint8_t>((1U << index(program.bits_per_pixel)) - 1);
    for (std::uint8_t& bits : program.pixels) bits &= mask;
    return program;
}

SequencerProgram repeated_program(const SequencerProgram& program, const SequencerProgram& memory) {
    SequencerProgram result = memory;
    result.period_slots = program.period_slots;
    result.pixels.clear();
    const bool opens = program.bits_per_pixel == 1 && memory.bits_per_pixel > 1;
    for (int slot = 0; slot < program.period_slots; ++slot)
        for (int row = 0; row < memory.tile_rows; ++row)
            for (int col = 0; col < memory.tile_cols; ++col) {
                const std::size_t from =
                    (index(slot) * index(program.tile_rows) + index(row % program.tile_rows)) *
                        index(program.tile_cols) +
                    index(col % program.tile_cols);
                result.pixels.push_back(static_cast<std::uint8_t>(
                    program.pixels[from] | (opens ? SequencerProgram::kOpen : 0U)));
            }
    return result;
}

ExposureSchedule schedule_of(const SequencerProgram& program, const std::string& where) {
    const ExposureFinder finder(program, where);
    std::vector<std::uint32_t> first = {0};
    std::vector<Exposure> exposures;
    for (int row = 0; row < program.tile_rows; ++row)
        for (int col = 0; col < program.tile_cols; ++col) {
            finder.find(row, col, 0, exposures);
            if (program.bits_per_pixel == 3)
                finder.find(row, col, SequencerProgram::kStore, exposures);
            first.push_back(static_cast<std::uint32_t>(exposures.size()));
        }
    return {program.tile_rows, program.tile_cols, program.period_slots, std::move(first),
            std::move(exposures)};
}

}  // namespace stipple
