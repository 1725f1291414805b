#include <Vchip_group.h>
#include <Vchip_one.h>
#include <Vchip_paper.h>
#include <Vchip_small.h>
#include <chip_sizes.h>
#include <verilated.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "core/index.h"
#include "readout/timing/slot_readout.h"
#include "tests/rtl/chip_run.h"

namespace stipple {
namespace {

/// Writes `value` into 32-bit word `place` of a port of any width. Verilator keeps ports as words,
/// the lowest first.
template <typename Port>
void set_word(Port& port, std::size_t place, std::uint32_t value) {
    std::memcpy(reinterpret_cast<char*>(&port) + 4 * place, &value, 4);
}

/// Bits [first, first + bits) of such a port; bits <= 8.
template <typename Port>
unsigned bits_of(const Port& port, std::size_t first, unsigned bits) {
    std::uint16_t two = 0;
    const std::size_t byte = first / 8;
    std::memcpy(&two, reinterpret_cast<const char*>(&port) + byte,
                std::min<std::size_t>(2, sizeof(Port) - byte));
    return (two >> (first % 8)) & ((1U << bits) - 1U);
}

/// Sets the registers of a chip.
template <typename Chip>
void set_registers(Chip& chip, const ChipProgram& program) {
    const ReadoutTiming& timing = program.timing;
    const auto whole = [](std::int64_t value) { return static_cast<std::uint32_t>(value); };
    chip.rows = static_cast<std::uint16_t>(program.window.rows);
    chip.cols = static_cast<std::uint16_t>(program.window.cols);
    chip.period = static_cast<std::uint8_t>(program.period_slots);
    chip.is_sequential = timing.row_timing == RowTiming::kSequential;
    chip.is_full_width = timing.row_timing == RowTiming::kFullWidth;
    chip.exposes_while_reading = timing.exposes_while_reading;
    chip.drops = program.budget.policy == OverrunPolicy::kDrop;
    chip.slot_clocks = whole(std::max(
        {program.budget.clocks, std::int64_t{1}, code_load_clocks(timing, program.window.rows)}));
    chip.budget_clocks = whole(program.budget.clocks);
    chip.rot_clocks = whole(timing.rot_clocks);
    chip.skip_row_clocks = whole(timing.skip_row_clocks);
    constexpr std::size_t kSettles = sizeof chip.settle_clocks / 4;
    const auto& settles = timing.settle_clocks;
    for (std::size_t i = 0; i < kSettles; ++i)
        set_word(chip.settle_clocks, i,
                 settles.empty() ? 0 : whole(settles[std::min(i, settles.size() - 1)]));
    chip.settle_margin = whole(timing.settle_margin);
    chip.adc_clocks = whole(timing.adc_clocks);
    chip.adc_skip = timing.adc_skip;
    chip.blanking_clocks = whole(timing.blanking_clocks);
    chip.clocks_per_column = whole(timing.clocks_per_column);
    chip.io_clocks = whole(timing.io_clocks);
    chip.link_bits = static_cast<std::uint64_t>(timing.link_lanes > 0
                                                    ? timing.addressing.channels *
                                                          timing.bits_per_sample * timing.clock_hz
                                                    : 0);
    chip.link_rate = static_cast<std::uint64_t>(timing.link_lanes * timing.link_bps);
    chip.has_table = !timing.row_table_cols.empty();
    for (std::size_t i = 0; chip.has_table && i < sizeof chip.table_cols / 4; ++i) {
        const std::size_t at = std::min(i, timing.row_table_cols.size() - 1);
        set_word(chip.table_cols, i, whole(timing.row_table_cols[at]));
        set_word(chip.table_clocks, i, whole(timing.row_table_clocks[at]));
    }
    chip.dark_rows = static_cast<std::uint8_t>(timing.dark_rows);
    chip.overhead_clocks = whole(timing.overhead_clocks);
    chip.overhead_rows = static_cast<std::uint16_t>(timing.overhead_rows);
    chip.full_row_clocks = whole(full_row_clocks(timing, program.window.cols));
    chip.stream_crc = program.stream_crc;
}

/// Clocks a chip, presents DN to it and notes what it does.
template <typename Chip>
class VerilatedRun {
  public:
    VerilatedRun(const ChipSize& size, const ChipProgram& program, const ColumnDn& dn)
        : size_(size), program_(program), dn_(dn), engine_(program.seed) {
        const std::string image = "+schedule=" + program.image.string();
        std::array<const char*, 2> arguments{"chip", image.c_str()};
        context_.commandArgs(static_cast<int>(arguments.size()), arguments.data());
        chip_ = std::make_unique<Chip>(&context_);
        set_registers(*chip_, program);
    }

    ChipRun run() {
        chip_->rst = 1;
        for (int i = 0; i < 2; ++i) clock(false);
        chip_->rst = 0;
        while ((run_.packets < program_.packets || run_.clocks < program_.min_clocks) &&
               run_.clocks < program_.max_clocks)
            clock(true);
        run_.fault = chip_->fault;
        chip_->final();
        return std::move(run_);
    }

  private:
    void clock(bool watch) {
        chip_->clk = 0;
        chip_->m_axis_tready = engine_() % 4 != 0;
        show({});
        chip_->eval();
        if (chip_->convert_end && !run_.events.scan_start.empty()) {
            show(dn_(static_cast<int>(run_.events.scan_start.size()) - 1, row(chip_->adc_row)));
            chip_->eval();
        }
        if (watch) note();
        chip_->clk = 1;
        chip_->eval();
    }
    /// The columns show these DN, columns without one anything.
    void show(const std::vector<std::uint16_t>& dn) {
        const auto depth = static_cast<unsigned>(size_.bit_depth);
        std::vector<std::uint32_t> words((index(size_.cols) * depth + 31) / 32);
        for (std::size_t i = 0; i < index(size_.cols) * depth; ++i) {
            const std::size_t col = i / depth;
            const unsigned value = col < dn.size() ? dn[col] : static_cast<unsigned>(engine_());
            words[i / 32] |= (value >> (i % depth) & 1U) << (i % 32);
        }
        for (std::size_t i = 0; i < words.size(); ++i) set_word(chip_->adc_dn, i, words[i]);
    }
    [[nodiscard]] int row(unsigned place) const {
        return static_cast<int>(place) - size_.dark_rows;
    }
    void note() {
        ChipEvents& events = run_.events;
        const std::int64_t now = run_.clocks;
        if (chip_->slot_start) events.slot_start.push_back({now, 0});
        if (events.slot_start.empty()) return;  // the tables are being filled
        if (chip_->scan_start) events.scan_start.push_back({now, 0});
        if (chip_->select) events.select.push_back({now, row(chip_->select_row)});
        if (chip_->convert) events.convert.push_back({now, row(chip_->convert_row)});
        if (chip_->convert_end) events.convert_end.push_back({now, row(chip_->adc_row)});
        if (chip_->transfer_end) events.transfer_end.push_back({now, events.transfer.back().row});
        if (chip_->transfer) events.transfer.push_back({now, row(chip_->transfer_row)});
        const auto place_bits =
            static_cast<unsigned>(std::bit_width(index(size_.rows + size_.dark_rows)));
        for (unsigned i = 0; i < 4; ++i)
            if ((chip_->row_done >> i & 1U) != 0)
                events.row_done.push_back(
                    {now, row(bits_of(chip_->row_done_row, i * place_bits, place_bits))});
        take_beat();
        ++run_.clocks;
    }
    void take_beat() {
        if (!chip_->m_axis_tvalid || !chip_->m_axis_tready) return;
        if (run_.packets == program_.packets) return;
        for (unsigned i = 0; i < static_cast<unsigned>(size_.word_bytes); ++i)
            if ((chip_->m_axis_tkeep >> i & 1U) != 0)
                run_.bytes.push_back(
                    static_cast<std::uint8_t>(bits_of(chip_->m_axis_tdata, index(8 * i), 8)));
        run_.packets += chip_->m_axis_tlast;
    }

    ChipSize size_;
    const ChipProgram& program_;
    const ColumnDn& dn_;
    std::mt19937 engine_;
    VerilatedContext context_;
    std::unique_ptr<Chip> chip_;
    ChipRun run_;
};

template <typename Chip>
ChipRun run_verilated(const ChipSize& size, const ChipProgram& program, const ColumnDn& dn) {
    return VerilatedRun<Chip>(size, program, dn).run();
}

}  // namespace

std::span<const ChipModel> chip_models() {
    static constexpr ChipModel kModels[] = {
        {"paper", paper_size, run_verilated<Vchip_paper>},
        {"small", small_size, run_verilated<Vchip_small>},
        {"group", group_size, run_verilated<Vchip_group>},
        {"one", one_size, run_verilated<Vchip_one>},
    };
    return kModels;
}

}  // namespace stipple
