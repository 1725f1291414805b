#include "readout/sequencer_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace stipple {
namespace {

std::size_t index(int value) {
    return static_cast<std::size_t>(value);
}

/// The bits of one pixel over the period.
class PixelProgram {
  public:
    PixelProgram(SequencerProgram& program, std::size_t pixel) : program_(program), pixel_(pixel) {}

    [[nodiscard]] std::uint8_t& at(std::uint32_t slot) const {
        const auto phase = slot % static_cast<std::uint32_t>(program_.period_slots);
        return program_
            .pixels[phase * index(program_.tile_rows) * index(program_.tile_cols) + pixel_];
    }

    void write(const Exposure& e, unsigned store) const {
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(e.span_slots()); ++i)
            if ((e.open_slots >> i & 1U) != 0)
                at(e.first_slot + i) = static_cast<std::uint8_t>(SequencerProgram::kOpen | store);
        at(e.first_slot + static_cast<std::uint32_t>(e.span_slots()) - 1) |=
            SequencerProgram::kRead;
    }

  private:
    SequencerProgram& program_;
    std::size_t pixel_;
};

/// The exposures of one pixel and store, found by following its bits from one reading to the next.
class ExposureFinder {
  public:
    ExposureFinder(const SequencerProgram& program, const std::string& place)
        : program_(program), place_(place) {}

    /// Appends the exposures of tile pixel (row, col) in `store` (0 or kStore).
    void find(int row, int col, unsigned store, std::vector<Exposure>& found) const {
        const auto fail = [&](int slot, std::string_view problem) {
            throw InputError(place_, fmt::format("pixel ({}, {}) slot {}: {}", row, col,
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
    const std::string& place_;
};

}  // namespace

SequencerProgram compile_schedule(const ExposureSchedule& schedule) {
    if (schedule.interleaved())
        throw InputError("sequencer program",
                         "exposures of a pixel interleave; there is no "
                         "program for two charge stores yet");
    SequencerProgram program{.tile_rows = schedule.tile_rows(),
                             .tile_cols = schedule.tile_cols(),
                             .period_slots = schedule.period_slots(),
                             .bits_per_pixel = schedule.gapless() ? 1 : 2,
                             .pixels = {}};
    const std::size_t tile = index(program.tile_rows) * index(program.tile_cols);
    program.pixels.resize(tile * index(program.period_slots));
    for (std::size_t pixel = 0; pixel < tile; ++pixel)
        for (const Exposure& e : schedule.exposures(static_cast<int>(pixel) / program.tile_cols,
                                                    static_cast<int>(pixel) % program.tile_cols))
            PixelProgram(program, pixel).write(e, 0);
    const auto mask = static_cast<std::uint8_t>((1U << unsigned(program.bits_per_pixel)) - 1);
    for (std::uint8_t& bits : program.pixels) bits &= mask;
    return program;
}

ExposureSchedule schedule_of(const SequencerProgram& program, const std::string& place) {
    const ExposureFinder finder(program, place);
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
