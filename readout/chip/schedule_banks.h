#pragma once

#include <cstdint>
#include <vector>

#include "core/exposure_schedule.h"
#include "readout/chip/chip_settings.h"
#include "readout/program/sequencer_program.h"

namespace stipple {

/// The schedule memory of a chip: two banks of words, written in parts of 32 bits
/// (docs/chip_registers.md, MEMORY_ADDRESS).
class ScheduleBanks {
  public:
    static constexpr int kBanks = 2;

    explicit ScheduleBanks(const ChipGeometry& geometry);

    /// Part 0 of this word is written next: bits 30:0 are its address, bit 31 its bank.
    void set_address(std::uint32_t address);
    /// The bank of that word.
    [[nodiscard]] int bank() const { return bank_; }
    /// Whether there is no such word.
    [[nodiscard]] bool is_beyond() const;
    /// Precondition: !is_beyond().
    void write(std::uint32_t part);

    /// Fills a bank; tile and bits of a pixel may be larger than those of the program. \throws
    /// InputError naming the limit if the program does not fit.
    void load(int bank, const SequencerProgram& program);
    /// The schedule of `period` slots that begins with slot `first` of a bank. \throws InputError
    /// as `schedule_of`.
    [[nodiscard]] ExposureSchedule schedule(int bank, int period, int first) const;

  private:
    [[nodiscard]] std::size_t words() const;
    [[nodiscard]] std::size_t place(int bank, std::size_t word) const;

    int tile_rows_, tile_cols_, depth_, pixel_bits_;
    std::vector<std::uint8_t> pixels_;  ///< order (bank, slot, row, col)
    int bank_ = 0;
    std::size_t word_ = 0;
    std::vector<std::uint32_t> parts_;  ///< of the word so far
};

}  // namespace stipple
