#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/flux_video.h"
#include "core/index.h"
#include "readout/chip_registers.h"
#include "readout/program/sequencer_program.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"
#include "stream/stream_writer.h"
#include "tests/rtl/chip_capture.h"
#include "tests/rtl/expected_run.h"
#include "tests/rtl/random_chip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

std::string byte_differences(const std::vector<std::uint8_t>& expected,
                             const std::vector<std::uint8_t>& given) {
    if (given == expected) return "";
    const auto [a, b] = std::ranges::mismatch(given, expected);
    return fmt::format("byte {} of {}, chip {}\n", b - expected.begin(), expected.size(),
                       given.size());
}

/// A run of the model with the file that it writes, and the same on the chip.
struct Comparison {
    const ChipModel& model;
    ReadoutTiming timing;
    const ExposureSchedule& schedule;
    FrameShape window;
    SlotBudget budget;
    int slots;

    int offset = 0;  ///< of the program in its bank

    /// Differences in words; `packets` are those of `file`.
    [[nodiscard]] std::string differences_from(const std::vector<SamplePacket>& packets,
                                               const std::filesystem::path& file,
                                               std::uint32_t seed) const {
        const StreamBytes bytes = read_stream_bytes(file);
        ReadoutCost cost(timing, schedule, window, budget);
        const auto [expected, scanned] = expected_run(cost, slots);
        const ColumnDn dn = [&](int scan, int row) {
            const int slot = scanned.at(index(scan));
            const auto packet = std::ranges::find(packets, slot, &SamplePacket::slot);
            return columns_of(*packet, schedule, window, row);
        };
        const auto chip = model.make(model.size, {"", bytes.header_crc, dn, seed});
        const SequencerProgram program = program_for(schedule, model.size, offset);
        load_bank(*chip, program, 0);
        set_up(*chip, {timing, window, budget, program.period_slots, offset, slots});
        const std::int64_t start = chip->clocks;
        set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
        wait_for_end(*chip, 2 * cost.clocks() + 100'000);
        return differences(expected, chip->events) + count_differences(*chip, packets) +
               byte_differences(bytes.packets, chip->bytes) + start_difference(*chip, start);
    }

  private:
    [[nodiscard]] std::string count_differences(ChipSimulation& chip,
                                                const std::vector<SamplePacket>& packets) const {
        std::map<std::uint32_t, std::uint32_t> expected{
            {STIPPLE_STATUS, 0}, {STIPPLE_ERROR, 0}, {STIPPLE_SLOT_COUNT, slots}};
        for (const SamplePacket& packet : packets) {
            ++expected[STIPPLE_PACKET_COUNT];
            expected[STIPPLE_SAMPLE_COUNT] += static_cast<std::uint32_t>(packet.dn.size());
            expected[STIPPLE_OVERRUN_COUNT] += packet.flags == SamplePacket::kOverrun ? 1 : 0;
            expected[STIPPLE_DROPPED_COUNT] += packet.flags == SamplePacket::kDropped ? 1 : 0;
        }
        std::string text;
        for (const auto& [address, value] : expected)
            if (const std::uint32_t is = get(chip, address); is != value)
                text += fmt::format("register 0x{:03X}: {}, chip {}\n", address, value, is);
        return text;
    }
    [[nodiscard]] std::string start_difference(const ChipSimulation& chip,
                                               std::int64_t start) const {
        if (budget.policy == OverrunPolicy::kDrop) return "";  // rehearses first
        const std::int64_t first =
            start + 2 +
            fill_clocks(model.size, window.rows, compile_schedule(schedule).period_slots);
        return chip.first_slot == first
                   ? ""
                   : fmt::format("slot 0: clock {}, chip {}\n", first, chip.first_slot);
    }
};

/// Packets of a run with DN that are drawn, and their file.
std::vector<SamplePacket> draw_packets(const Comparison& it, const std::filesystem::path& file,
                                       Draw& draw) {
    StreamWriter writer(file, {.shape = it.window,
                               .calibration = {.bit_depth = it.model.size.bit_depth},
                               .schedule = it.schedule,
                               .schedule_source = {},
                               .schedule_name = "",
                               .provenance = ""});
    ReadoutCost cost(it.timing, it.schedule, it.window, it.budget);
    std::vector<SamplePacket> packets;
    for (int slot = 0; slot < it.slots; ++slot) {
        const SlotCost& read = cost.add_next();
        const bool is_cut = read.end_row < it.window.rows;
        const bool is_long = read.overrun && !is_cut;
        SamplePacket packet{slot, 0, read.end_row, std::uint8_t{is_long}, {}};
        packet.dn.resize(count_due(it.schedule, slot, 0, read.end_row, it.window.cols));
        for (std::uint16_t& dn : packet.dn)
            dn = static_cast<std::uint16_t>(draw(0, (1 << it.model.size.bit_depth) - 1));
        if (read.end_row > 0) packets.push_back(packet);
        if (is_cut)
            packets.push_back(
                {slot, read.end_row, it.window.rows - read.end_row, SamplePacket::kDropped, {}});
    }
    for (const SamplePacket& packet : packets) writer.write(packet);
    writer.finish();
    return packets;
}

/// Times of a random sensor that a chip of this size can have, and a window of it.
Comparison random_comparison(const ChipModel& chip, const ExposureSchedule& schedule, Draw& draw) {
    const ReadoutTiming timing = random_chip_timing(chip.size, draw);
    const FrameShape window{draw(1, chip.size.rows), draw(1, chip.size.cols), 1};
    Comparison it{chip, timing, schedule, window, {}, draw(10, 40)};
    it.offset = draw(0, compile_schedule(schedule).period_slots - 1);
    ReadoutCost cost(timing, schedule, window, {});
    for (int slot = 0; slot < it.slots; ++slot) cost.add_next();
    if (draw(0, 3) == 0) return it;
    it.budget.clocks = draw(1, static_cast<int>(3 * cost.totals().readout_clocks / it.slots) + 9);
    if (draw(0, 1) == 0) return it;
    try {
        const SlotBudget drops{it.budget.clocks, OverrunPolicy::kDrop};
        const ReadoutCost possible(timing, schedule, window, drops);
        it.budget = drops;
    } catch (const InputError&) {  // whatever is dropped, no row can be read
    }
    return it;
}

TEST(RtlTest, RunsRandomSensorsAndSchedulesAsTheModelClockByClock) {
    const TemporaryFolder folder;
    constexpr std::uint32_t kRuns = 200;
    int overruns = 0, dropped = 0, laws[3] = {};
    for (std::uint32_t seed = 0; seed < kRuns; ++seed) {
        Draw draw(seed);
        const ChipModel& chip = chip_models()[seed % chip_models().size()];
        const ExposureSchedule schedule = schedule_for(chip.size, seed, draw);
        const Comparison it = random_comparison(chip, schedule, draw);
        const auto packets = draw_packets(it, folder / "a.stipple", draw);
        ASSERT_EQ(it.differences_from(packets, folder / "a.stipple", seed), "")
            << "seed " << seed << ", chip " << chip.name;
        for (const SamplePacket& packet : packets) {
            overruns += packet.flags == SamplePacket::kOverrun ? 1 : 0;
            dropped += packet.flags == SamplePacket::kDropped ? 1 : 0;
        }
        ++laws[static_cast<int>(it.timing.row_timing)];
    }
    EXPECT_GT(overruns, 200);
    EXPECT_GT(dropped, 100);
    for (const int law : laws) EXPECT_GT(law, 40);
}

/// Light that differs from pixel to pixel and from slot to slot.
FluxVideo light_of(FrameShape shape, int slots, Draw& draw) {
    FluxVideo light(slots, shape);
    for (float& value : light.data()) value = static_cast<float>(draw(0, 1000)) / 100;
    return light;
}

/// The emulated sensor records a file; the chip runs the same schedule with its samples.
void expect_the_emulator_s_file(const ChipModel& chip, const SensorChoice& choice) {
    SCOPED_TRACE(choice.sensor + ", " + choice.schedule);
    const TemporaryFolder folder;
    Draw draw(1);
    const FrameShape shape{chip.size.rows, chip.size.cols, 1};
    SensorSetup setup = set_up_sensor(choice, shape);
    setup.params.bit_depth = chip.size.bit_depth;
    setup.timing = fitted(*setup.timing, chip.size);
    setup.timing->bits_per_sample = chip.size.bit_depth;
    setup.timing->code_load_clocks = 0;  // of a larger array
    const Comparison it{chip,
                        *setup.timing,
                        setup.schedule.schedule,
                        shape,
                        {slot_clocks(*setup.timing, setup.params.slot_us), setup.overrun},
                        2 * setup.schedule.schedule.period_slots() + 3};
    const FluxVideo light = light_of(shape, it.slots, draw);
    StreamRecorder recorder(folder / "a.stipple", setup);
    std::vector<SamplePacket> packets;
    for (int slot = 0; slot < it.slots; ++slot)
        for (const SamplePacket& packet : recorder.expose(light.frame(slot)))
            packets.push_back(packet);
    recorder.finish();
    EXPECT_EQ(it.differences_from(packets, folder / "a.stipple", 1), "");
}

TEST(RtlTest, GivesTheFileOfTheEmulatorForTiledOnEachLaw) {
    for (const char* sensor : {"lux1310", "imx273", "vita", "cmv4000"})
        for (const char* slot : {"slot_us=2", "slot_us=20"})
            expect_the_emulator_s_file(model("paper"),
                                       {.sensor = sensor, .schedule = "tiled", .settings = {slot}});
}

TEST(RtlTest, GivesTheFileOfTheEmulatorForTheSchedulesOfTheCatalogue) {
    for (const char* schedule :
         {"alternating", "coded_rolling_shutter_exposure", "coded_rolling_shutter_staggered", "dol",
          "flexible_voxels", "full1x", "full4x", "multi_phase_2x2", "nd_mosaic",
          "spatially_varying_exposure"})
        expect_the_emulator_s_file(
            model("small"), {.sensor = "lux1310", .schedule = schedule, .settings = {"slot_us=5"}});
    for (const char* schedule :
         {"tiled", "single_bump", "random_subset", "pixel_flutter", "two_bucket"})
        expect_the_emulator_s_file(model("group"),
                                   {.sensor = "lux1310",
                                    .schedule = schedule,
                                    .settings = {"slot_us=5", "charge_stores=2"},
                                    .schedule_settings = {"tile_rows=12", "tile_cols=6"}});
    expect_the_emulator_s_file(model("small"),
                               {.sensor = "lux1310",
                                .schedule = "tiled",
                                .settings = {"slot_us=3"},
                                .schedule_settings = {"tile_rows=12", "tile_cols=12"},
                                .overrun = OverrunPolicy::kDrop});
    expect_the_emulator_s_file(model("one"), {.sensor = "lux1310",
                                              .schedule = "rolling",
                                              .settings = {"slot_us=5"},
                                              .schedule_settings = {"rows_per_slot=1"}});
}

}  // namespace
}  // namespace stipple
