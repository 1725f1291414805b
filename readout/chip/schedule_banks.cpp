#include "readout/chip/schedule_banks.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/index.h"

namespace stipple {
namespace {

/// `bits` bits of `parts` from bit `first` on.
std::uint8_t bits_at(const std::vector<std::uint32_t>& parts, std::size_t first, std::size_t bits) {
    unsigned value = 0;
    for (std::size_t i = 0; i < bits; ++i)
        value |= (parts[(first + i) / 32] >> ((first + i) % 32) & 1U) << i;
    return static_cast<std::uint8_t>(value);
}

}  // namespace

ScheduleBanks::ScheduleBanks(const ChipGeometry& geometry)
    : tile_rows_(geometry.tile_rows),
      tile_cols_(geometry.tile_cols),
      depth_(geometry.depth),
      pixel_bits_(geometry.pixel_bits),
      pixels_(kBanks * words() * index(tile_cols_)) {}

std::size_t ScheduleBanks::words() const {
    return index(depth_) * index(tile_rows_);
}

std::size_t ScheduleBanks::place(int bank, std::size_t word) const {
    return (index(bank) * words() + word) * index(tile_cols_);
}

void ScheduleBanks::set_address(std::uint32_t address) {
    bank_ = static_cast<int>(address >> 31U);
    word_ = address & 0x7FFFFFFFU;
    parts_.clear();
}

bool ScheduleBanks::is_beyond() const {
    return word_ >= words();
}

void ScheduleBanks::write(std::uint32_t part) {
    const std::size_t cols = index(tile_cols_), bits = index(pixel_bits_);
    parts_.push_back(part);
    if (32 * parts_.size() < cols * bits) return;
    for (std::size_t col = 0; col < cols; ++col)
        pixels_[place(bank_, word_) + col] = bits_at(parts_, col * bits, bits);
    parts_.clear();
    ++word_;
}

void ScheduleBanks::load(int bank, const SequencerProgram& program) {
    const auto refuse = [](const std::string& why) { throw InputError("schedule", why); };
    if (tile_rows_ % program.tile_rows != 0 || tile_cols_ % program.tile_cols != 0)
        refuse(
            fmt::format("its tile of {} x {} pixels (cols x rows) does not divide that of the "
                        "schedule memory, {} x {}",
                        program.tile_cols, program.tile_rows, tile_cols_, tile_rows_));
    if (program.period_slots > depth_)
        refuse(fmt::format("its {} slots are more than the {} of a bank of the schedule memory",
                           program.period_slots, depth_));
    if (program.bits_per_pixel > pixel_bits_)
        refuse(fmt::format("its {} bits of a pixel are more than the {} of the schedule memory",
                           program.bits_per_pixel, pixel_bits_));
    const SequencerProgram repeated = repeated_program(program, {.tile_rows = tile_rows_,
                                                                 .tile_cols = tile_cols_,
                                                                 .bits_per_pixel = pixel_bits_,
                                                                 .pixels = {}});
    std::ranges::copy(repeated.pixels,
                      pixels_.begin() + static_cast<std::ptrdiff_t>(place(bank, 0)));
}

ExposureSchedule ScheduleBanks::schedule(int bank, int period, int first) const {
    SequencerProgram program{.tile_rows = tile_rows_,
                             .tile_cols = tile_cols_,
                             .period_slots = period,
                             .bits_per_pixel = pixel_bits_,
                             .pixels = {}};
    const std::size_t slot_pixels = index(tile_rows_) * index(tile_cols_);
    for (int slot = 0; slot < period; ++slot) {
        const auto from =
            pixels_.begin() + static_cast<std::ptrdiff_t>(
                                  place(bank, 0) + index((slot + first) % period) * slot_pixels);
        program.pixels.insert(program.pixels.end(), from,
                              from + static_cast<std::ptrdiff_t>(slot_pixels));
    }
    return schedule_of(program, fmt::format("bank {}", bank));
}

}  // namespace stipple
