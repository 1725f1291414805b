#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {

/// A schedule as the memory of a chip's sequencer (docs/sequencer_program.md): one to three bits
/// for each slot of the period, row and column of the tile.
struct SequencerProgram {
    static constexpr unsigned kRead = 1;   ///< bit 0: read the store at the end of the slot
    static constexpr unsigned kOpen = 2;   ///< bit 1: collect light in this slot
    static constexpr unsigned kStore = 4;  ///< bit 2: in the second charge store, not the first

    int tile_rows = 0;
    int tile_cols = 0;
    int period_slots = 0;
    /// 1: kRead only, every pixel collects light in every slot; 2: kOpen too; 3: kStore too.
    int bits_per_pixel = 1;
    std::vector<std::uint8_t> pixels;  ///< order (slot, row, col), 0 <= value < 2^bits_per_pixel

    /// Size of the memory.
    [[nodiscard]] std::uint64_t bits() const {
        return pixels.size() * static_cast<std::uint64_t>(bits_per_pixel);
    }
    bool operator==(const SequencerProgram&) const = default;
};

/// True if some exposure takes one charge store in even repetitions of the period and the other in
/// odd. Precondition: charge_stores() <= 2.
[[nodiscard]] bool stores_alternate(const ExposureSchedule& schedule);

/// `SequencerProgram::bits_per_pixel` of a schedule.
[[nodiscard]] int program_bits_per_pixel(const ExposureSchedule& schedule);

/// Memory of the sequencer for one period of the schedule, in bits: per slot and pixel of the tile
/// one bit, two with gaps, three with two charge stores.
[[nodiscard]] std::uint64_t schedule_memory_bits(const ExposureSchedule& schedule);

/// The program of a schedule. It covers the period once, or twice if an exposure changes its charge
/// store from one period to the next. \throws InputError if the schedule needs more than two charge
/// stores or has weights.
[[nodiscard]] SequencerProgram compile_schedule(const ExposureSchedule& schedule);

/// The same program for a memory whose tile and bits per pixel may be larger: the tile is repeated,
/// and a pixel that is always open is said to be. Precondition: `memory` has tile_rows, tile_cols
/// that those of the program divide, and no fewer bits_per_pixel; its other members are not used.
[[nodiscard]] SequencerProgram repeated_program(const SequencerProgram& program,
                                                const SequencerProgram& memory);

/// The schedule of `program`: an exposure of a store begins in the first open slot
/// after its last reading. `schedule_of(compile_schedule(s)) == s` if the periods are equal.
/// \throws InputError naming `where`, pixel and slot: a pixel is read while it is closed, is open
/// and never read, or is open for more than 64 slots from the first to the last.
[[nodiscard]] ExposureSchedule schedule_of(const SequencerProgram& program,
                                           const std::string& where);

}  // namespace stipple
