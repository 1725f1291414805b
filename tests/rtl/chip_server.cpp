// usage: chip_server PACKETS STREAM... : the chip "firmware" in gates, driven by the protocol of
// docs/chip.md through standard input and output. Its columns show the samples of STREAM, the file
// of the emulated chip's capture of the same number. Writes the bytes of all packets.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/schedule_parts.h"
#include "core/text.h"
#include "readout/chip_registers.h"
#include "stream/schedule_switch.h"
#include "stream/stream_reader.h"
#include "tests/rtl/expected_run.h"
#include "tests/rtl/random_chip.h"

namespace stipple {
namespace {

/// The columns of the rows of a recorded capture.
class RecordedColumns {
  public:
    explicit RecordedColumns(const std::filesystem::path& file)
        : crc_(read_stream_bytes(file).header_crc), reader_(file) {
        reader_.follow_switches();
        for (SamplePacket packet; reader_.next(packet);)
            if (!packet.dn.empty()) scans_.push_back(packet);
    }
    [[nodiscard]] std::uint32_t crc() const { return crc_; }
    [[nodiscard]] std::vector<std::uint16_t> of(int scan, int row) const {
        SamplePacket packet = scans_.at(index(scan));
        const auto parts = schedule_parts(reader_.header());
        const SchedulePart& part = parts[part_at(parts, packet.slot)];
        packet.slot = readout_slot(part, packet.slot);
        return columns_of(packet, *part.schedule, reader_.header().shape, row);
    }

  private:
    std::uint32_t crc_;
    StreamReader reader_;
    std::vector<SamplePacket> scans_;
};

class ChipServer {
  public:
    explicit ChipServer(std::vector<std::string> streams) : streams_(std::move(streams)) {
        const ChipModel& chip = model("firmware");
        chip_ = chip.make(
            chip.size, {"", 0, [this](int scan, int row) { return columns_->of(scan, row); }, 1});
    }

    std::string answer(const std::string& line) {
        std::istringstream words(line);
        std::string request, first, second;
        words >> request >> first >> second;
        const auto number = [](const std::string& text) {
            return static_cast<std::uint32_t>(std::stoul(text, nullptr, 0));
        };
        if (request == "t") {
            chip_->wait(number(first));
            return "ok";
        }
        const std::uint32_t address = number(first);
        if (request == "r") {
            const auto value = chip_->read(address);
            return value ? fmt::format("0x{:08X}", *value) : "error SLVERR";
        }
        if (address == STIPPLE_CONTROL && (number(second) & STIPPLE_CONTROL_START) != 0) begin();
        return chip_->write(address, number(second)) ? "ok" : "error SLVERR";
    }
    [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return chip_->bytes; }

  private:
    void begin() {
        columns_.emplace(streams_.at(captures_++));
        chip_->set_stream_crc(columns_->crc());
        chip_->events = {};
    }

    std::vector<std::string> streams_;
    std::size_t captures_ = 0;
    std::optional<RecordedColumns> columns_;
    std::unique_ptr<ChipSimulation> chip_;
};

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    try {
        if (argc < 2) throw stipple::InputError("chip_server", "needs PACKETS STREAM...");
        stipple::ChipServer chip({argv + 2, argv + argc});
        for (std::string line; std::getline(std::cin, line);)
            std::cout << chip.answer(line) << std::endl;
        std::ofstream out(argv[1], std::ios::binary);
        std::ranges::copy(chip.bytes(), std::ostreambuf_iterator<char>(out));
        return 0;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 1;
    }
}
