#include "tests/rtl/chip_capture.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/index.h"
#include "readout/chip_registers.h"

namespace stipple {
namespace {

std::uint32_t word(std::int64_t value) {
    return static_cast<std::uint32_t>(value);
}

}  // namespace

std::int64_t fill_clocks(const ChipParameters& size, int rows, int period_slots) {
    return std::int64_t{3 * size.tile_rows + 2 * rows} * period_slots;
}

void set(ChipSimulation& chip, std::uint32_t address, std::uint32_t value) {
    if (!chip.write(address, value))
        throw InputError(fmt::format("register 0x{:03X}", address),
                         fmt::format("does not take {}", value));
}

std::uint32_t get(ChipSimulation& chip, std::uint32_t address) {
    const auto value = chip.read(address);
    if (!value) throw InputError(fmt::format("register 0x{:03X}", address), "is not there");
    return *value;
}

void set_up(ChipSimulation& chip, const ChipCapture& capture) {
    const int bank = (get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_BANK) != 0 ? 1 : 0;
    for (const auto& [address, value] : capture_registers(capture, bank)) set(chip, address, value);
}

void load_bank(ChipSimulation& chip, const SequencerProgram& program, int bank) {
    set(chip, STIPPLE_MEMORY_ADDRESS, word(bank) << 31U);
    const auto bits = static_cast<std::size_t>(program.bits_per_pixel);
    const std::size_t row_pixels = index(program.tile_cols);
    for (std::size_t first = 0; first < program.pixels.size(); first += row_pixels) {
        std::vector<std::uint32_t> parts((row_pixels * bits + 31) / 32);
        for (std::size_t bit = 0; bit < row_pixels * bits; ++bit)
            parts[bit / 32] |= (program.pixels[first + bit / bits] >> (bit % bits) & 1U)
                               << (bit % 32);
        for (const std::uint32_t part : parts) set(chip, STIPPLE_MEMORY_DATA, part);
    }
    set(chip, STIPPLE_BANK_PERIOD + 4 * word(bank), word(program.period_slots));
}

void wait_for_end(ChipSimulation& chip, std::int64_t max_clocks) {
    const std::int64_t last = chip.clocks + max_clocks;
    while ((get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_RUNNING) != 0) {
        if (chip.clocks > last) throw InputError("chip", "does not end its capture");
        chip.wait(20);
    }
}

}  // namespace stipple
