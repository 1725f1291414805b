#include "readout/chip/chip_project.h"

#include <chip_file_parts.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "io/text_file.h"
#include "readout/chip/register_map.h"
#include "readout/program/program_text.h"
#include "readout/timing/slot_readout.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr auto kStream = "expected.stipple";

SlotBudget budget_of(const SensorSetup& setup) {
    return {slot_clocks(*setup.timing, setup.params.slot_us), setup.overrun};
}

std::uint64_t little_endian(std::span<const char> bytes) {
    std::uint64_t value = 0;
    for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte)
        value = value << 8U | static_cast<unsigned char>(*byte);
    return value;
}

/// Sizes of a stream (docs/stream_format.md).
struct StreamParts {
    std::uint64_t header_bytes = 0;
    std::uint64_t end_bytes = 0;  ///< index and end marker
    std::uint32_t header_crc = 0;
};

StreamParts parts_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const auto read = [&](std::uint64_t at, std::size_t bytes) {
        std::array<char, 8> buffer{};
        in.seekg(static_cast<std::streamoff>(at));
        in.read(buffer.data(), static_cast<std::streamsize>(bytes));
        return little_endian(std::span(buffer).first(bytes));
    };
    const std::uint64_t all = fs::file_size(file);
    const std::uint64_t header = read(12, 4);
    return {.header_bytes = header,
            .end_bytes = all - read(all - 16, 8),
            .header_crc = static_cast<std::uint32_t>(read(header - 4, 4))};
}

void replace(std::string& text, std::string_view key, const std::string& value) {
    for (auto at = text.find(key); at != std::string::npos; at = text.find(key, at + value.size()))
        text.replace(at, key.size(), value);
}

void write(const fs::path& folder, const std::string& name, std::string_view text) {
    write_whole(folder / name, name, text);
}

struct Signal {
    const char* name;
    int bits;
    const char* flags;  ///< of GTKWave
};
struct SignalGroup {
    const char* title;
    std::vector<Signal> signals;
};

std::vector<SignalGroup> signal_groups(const ChipParameters& chip) {
    const auto place = static_cast<int>(
        std::bit_width(static_cast<unsigned>(chip.rows) + static_cast<unsigned>(chip.dark_rows)));
    constexpr auto kBits = "@28", kDecimal = "@24", kHex = "@22";
    return {{"Clock", {{"clk", 1, kBits}, {"rst", 1, kBits}}},
            {"Registers (AXI4-Lite)",
             {{"s_axil_awvalid", 1, kBits},
              {"s_axil_awaddr", 12, kHex},
              {"s_axil_wdata", 32, kHex},
              {"s_axil_bvalid", 1, kBits},
              {"s_axil_arvalid", 1, kBits},
              {"s_axil_araddr", 12, kHex},
              {"s_axil_rdata", 32, kHex},
              {"s_axil_rvalid", 1, kBits}}},
            {"Slots", {{"slot_start", 1, kBits}, {"scan_start", 1, kBits}}},
            {"Conversion of a row",
             {{"select", 1, kBits},
              {"select_row", place, kDecimal},
              {"convert", 1, kBits},
              {"convert_row", place, kDecimal},
              {"convert_end", 1, kBits},
              {"adc_row", place, kDecimal}}},
            {"Transfer of a row",
             {{"transfer", 1, kBits},
              {"transfer_row", place, kDecimal},
              {"channel_valid", chip.channels, kBits},
              {"transfer_end", 1, kBits}}},
            {"Stream (AXI-Stream)",
             {{"m_axis_tvalid", 1, kBits},
              {"m_axis_tdata", 8 * chip.word_bytes, kHex},
              {"m_axis_tkeep", chip.word_bytes, kHex},
              {"m_axis_tlast", 1, kBits}}}};
}

}  // namespace

ChipProject::ChipProject(const fs::path& folder, const SensorSetup& setup, int slots,
                         const std::string& provenance)
    : folder_(folder),
      setup_(setup),
      program_(compile_schedule(setup.schedule.schedule)),
      chip_(chip_parameters(setup, program_)),
      capture_{.timing = *setup.timing,
               .window = setup.shape,
               .budget = budget_of(setup),
               .period_slots = program_.period_slots,
               .slots = slots},
      recorder_(folder / kStream, setup, {.provenance = provenance}),
      cost_(*setup.timing, setup.schedule.schedule, setup.shape, capture_.budget),
      dn_(folder / "dn.mem") {
    write_registers();
    write(folder_, "schedule.mem", program_text({setup.schedule.name, program_}));
    write_view();
}

void ChipProject::expose(std::span<const float> frame) {
    const std::int64_t slot = cost_.slots();
    const SlotCost cost = cost_.add_next();
    const SlotTimes times = cost_.times(slot, cost);
    const auto packets = recorder_.expose(frame);
    // Without another row the dark rows are not read either.
    for (const RowTimes& row : times.rows)
        if (row.load.row >= 0) write_row(packets.front(), row.load.row);
    if (!dn_) throw DeviceError("dn.mem", "cannot be written; is there room?");
}

void ChipProject::write_row(const SamplePacket& packet, int row) {
    const auto depth = index(chip_.bit_depth);
    const ExposureSchedule& schedule = setup_.schedule.schedule;
    std::string digits((index(chip_.cols) * depth + 3) / 4, '0');
    std::size_t sample = count_due(schedule, packet.slot, 0, row, chip_.cols);
    for_each_readout(schedule, packet.slot, row, chip_.cols, [&](int col, int) {
        const unsigned dn = packet.dn[sample++];
        for (std::size_t bit = 0; bit < depth; ++bit) {
            const std::size_t at = index(col) * depth + bit;
            char& digit = digits[digits.size() - 1 - at / 4];
            const unsigned value =
                static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10) |
                (dn >> bit & 1U) << (at % 4);
            digit = "0123456789abcdef"[value];
        }
    });
    dn_ << digits << '\n';
}

void ChipProject::write_registers() const {
    std::string text;
    for (const auto& [address, value] : capture_registers(capture_, 0))
        text += fmt::format("{:03x} {:08x} {}\n", address, value, register_name(address));
    write(folder_, "registers.txt", text);
}

void ChipProject::write_parameters(std::uint32_t stream_crc) const {
    const std::pair<const char*, int> sizes[] = {
        {"ROWS", chip_.rows},
        {"COLS", chip_.cols},
        {"CHANNELS", chip_.channels},
        {"COLUMNS_PER_ADC", chip_.columns_per_adc},
        {"GROUP_ROWS", chip_.group_rows},
        {"GROUP_COLS", chip_.group_cols},
        {"TILE_ROWS", chip_.tile_rows},
        {"TILE_COLS", chip_.tile_cols},
        {"PIXEL_BITS", chip_.pixel_bits},
        {"DEPTH", chip_.depth},
        {"BIT_DEPTH", chip_.bit_depth},
        {"DARK_ROWS", chip_.dark_rows},
        {"WORD_BYTES", chip_.word_bytes},
        {"WORDS", chip_.words},
    };
    std::string text = "// Sizes of the chip (docs/rtl.md).\n`ifndef CHIP_VH\n`define CHIP_VH\n";
    for (const auto& [name, value] : sizes)
        text += fmt::format("`define CHIP_{} {}\n", name, value);
    text += fmt::format(
        "// Of its ports: $clog2(ROWS + DARK_ROWS + 1).\n`define CHIP_PLACE_BITS {}\n"
        "// For the test bench.\n`define CHIP_STREAM_CRC 32'h{:08x}\n`define CHIP_HALF_CLOCK_PS "
        "{}\n`endif\n",
        std::bit_width(static_cast<unsigned>(chip_.rows + chip_.dark_rows)), stream_crc,
        std::max<std::int64_t>(1, 500'000'000'000 / setup_.timing->clock_hz));
    write(folder_, "chip.vh", text);
}

void ChipProject::write_view() const {
    std::string text = "[*] the chip in its test bench, by stipple\n[dumpfile] \"chip.fst\"\n";
    for (const SignalGroup& group : signal_groups(chip_)) {
        text += fmt::format("@200\n-{}\n", group.title);
        for (const auto& [name, bits, flags] : group.signals)
            text += fmt::format("{}\ntestbench.{}{}\n", flags, name,
                                bits > 1 ? fmt::format("[{}:0]", bits - 1) : "");
    }
    write(folder_, "chip.gtkw", text);
}

std::string ChipProject::filled_in(std::string text, std::uint64_t header_bytes,
                                   std::uint64_t end_bytes) const {
    const std::pair<std::string_view, std::string> values[] = {
        {"@SENSOR@", setup_.params.name},
        {"@SCHEDULE@", setup_.schedule.name},
        {"@COLS@", std::to_string(chip_.cols)},
        {"@ROWS@", std::to_string(chip_.rows)},
        {"@CHANNELS@", std::to_string(chip_.channels)},
        {"@BIT_DEPTH@", std::to_string(chip_.bit_depth)},
        {"@SLOTS@", std::to_string(capture_.slots)},
        {"@SLOT_CLOCKS@", std::to_string(capture_.budget.clocks)},
        {"@HEADER_BYTES@", std::to_string(header_bytes)},
        {"@END_BYTES@", std::to_string(end_bytes)},
    };
    for (const auto& [key, value] : values) replace(text, key, value);
    return text;
}

void ChipProject::finish() {
    recorder_.finish();
    dn_.close();
    if (!dn_) throw DeviceError("dn.mem", "cannot be written; is there room?");
    const StreamParts parts = parts_of(folder_ / kStream);
    write_parameters(parts.header_crc);
    chip_files::for_each([&](const std::string& name, std::string_view content) {
        const bool is_text = name == "README.md" || name == "Makefile";
        write(folder_, name,
              is_text ? filled_in(std::string(content), parts.header_bytes, parts.end_bytes)
                      : content);
    });
}

bool ChipProject::is_own(std::string_view name) {
    bool is_ours = false;
    chip_files::for_each([&](std::string_view own, std::string_view) { is_ours |= own == name; });
    for (const std::string_view own :
         {"chip.vh", "chip.gtkw", "dn.mem", "expected.stipple", "registers.txt", "schedule.mem"})
        is_ours |= own == name;
    return is_ours;
}

}  // namespace stipple
