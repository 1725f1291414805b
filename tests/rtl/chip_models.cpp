#include <Vchip_firmware.h>
#include <Vchip_group.h>
#include <Vchip_one.h>
#include <Vchip_paper.h>
#include <Vchip_small.h>
#include <chip_sizes.h>
#include <verilated.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <typeinfo>
#include <utility>

#include "core/index.h"
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

/// Clocks a chip, presents DN to it and notes what it does.
template <typename Chip>
class VerilatedChip : public ChipSimulation {
  public:
    VerilatedChip(const ChipParameters& size, const ChipSurroundings& with)
        : size_(size), dn_(with.dn), engine_(with.seed) {
        const std::string image = "+schedule=" + with.image.string();
        std::array<const char*, 2> arguments{"chip", image.c_str()};
        context_.commandArgs(with.image.empty() ? 1 : 2, arguments.data());
        chip_ = std::make_unique<Chip>(&context_);
        chip_->stream_crc = with.stream_crc;
        chip_->s_axil_bready = chip_->s_axil_rready = 1;
        chip_->s_axil_wstrb = 0xF;
        chip_->rst = 1;
        wait(2);
        chip_->rst = 0;
        clocks = 0;
    }
    VerilatedChip(const VerilatedChip&) = delete;
    VerilatedChip& operator=(const VerilatedChip&) = delete;
    ~VerilatedChip() override {
        chip_->final();
        // Verilator takes the chip out of the context of the thread, which may be a later chip's.
        Verilated::threadContextp(&context_);
#if VM_COVERAGE
        static int chips = 0;
        if (const char* folder = std::getenv("STIPPLE_RTL_COVERAGE"))
            context_.coveragep()->write(
                (std::string(folder) + "/" + typeid(Chip).name() + std::to_string(chips++) + ".dat")
                    .c_str());
#endif
    }

    std::optional<std::uint32_t> read(std::uint32_t address) override {
        chip_->s_axil_araddr = static_cast<std::uint16_t>(address);
        chip_->s_axil_arvalid = 1;
        clock();
        chip_->s_axil_arvalid = 0;
        const bool is_good = chip_->s_axil_rresp == 0;
        const std::uint32_t value = chip_->s_axil_rdata;
        clock();
        return is_good ? std::optional(value) : std::nullopt;
    }
    bool write(std::uint32_t address, std::uint32_t value) override {
        chip_->s_axil_awaddr = static_cast<std::uint16_t>(address);
        chip_->s_axil_wdata = value;
        chip_->s_axil_awvalid = chip_->s_axil_wvalid = 1;
        clock();
        chip_->s_axil_awvalid = chip_->s_axil_wvalid = 0;
        const bool is_good = chip_->s_axil_bresp == 0;
        clock();
        return is_good;
    }
    void set_stream_crc(std::uint32_t crc) override {
        chip_->stream_crc = crc;
    }
    void wait(std::int64_t count) override {
        for (std::int64_t i = 0; i < count; ++i) clock();
    }

  private:
    void clock() {
        chip_->clk = 0;
        chip_->m_axis_tready = engine_() % 4 != 0;
        show({});
        chip_->eval();
        if (chip_->convert_end && !events.scan_start.empty()) {
            show(dn_(static_cast<int>(events.scan_start.size()) - 1, row(chip_->adc_row)));
            chip_->eval();
        }
        note();
        chip_->clk = 1;
        chip_->eval();
        ++clocks;
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
        if (chip_->slot_start && first_slot < 0) first_slot = clocks;
        if (first_slot < 0) return;  // the tables are being filled
        const std::int64_t now = clocks - first_slot;
        if (chip_->slot_start) events.slot_start.push_back({now, 0});
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
    }
    void take_beat() {
        if (!chip_->m_axis_tvalid || !chip_->m_axis_tready) return;
        for (unsigned i = 0; i < static_cast<unsigned>(size_.word_bytes); ++i)
            if ((chip_->m_axis_tkeep >> i & 1U) != 0)
                bytes.push_back(
                    static_cast<std::uint8_t>(bits_of(chip_->m_axis_tdata, index(8 * i), 8)));
        packets += chip_->m_axis_tlast;
    }

    ChipParameters size_;
    ColumnDn dn_;
    std::mt19937 engine_;
    VerilatedContext context_;
    std::unique_ptr<Chip> chip_;
};

template <typename Chip>
std::unique_ptr<ChipSimulation> make_chip(const ChipParameters& size,
                                          const ChipSurroundings& with) {
    return std::make_unique<VerilatedChip<Chip>>(size, with);
}

}  // namespace

std::span<const ChipModel> chip_models() {
    static constexpr ChipModel kModels[] = {
        {"paper", paper_size, make_chip<Vchip_paper>},
        {"small", small_size, make_chip<Vchip_small>},
        {"group", group_size, make_chip<Vchip_group>},
        {"one", one_size, make_chip<Vchip_one>},
        {"firmware", firmware_size, make_chip<Vchip_firmware>},
    };
    return kModels;
}

}  // namespace stipple
