#include "readout/stream_recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/flux_video.h"
#include "readout/coded_sensor.h"
#include "readout/light_throughput.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "readout/timing/readout_cost.h"
#include "sensor_model/slot_light.h"
#include "stream/stream_reader.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr int kSlots = 24;
constexpr FrameShape kShape{.rows = 32, .cols = 48, .planes = 1};

/// Light that differs from site to site and from slot to slot.
FluxVideo ramp(FrameShape shape) {
    FluxVideo video(kSlots, shape);
    float light = 0;
    for (float& value : video.data()) value = light = std::fmod(light + 0.37F, 3.0F);
    return video;
}

std::vector<SamplePacket> record(StreamRecorder& recorder, const FluxVideo& video) {
    std::vector<SamplePacket> all;
    for (int slot = 0; slot < video.slots(); ++slot)
        for (const SamplePacket& packet : recorder.expose(video.frame(slot))) all.push_back(packet);
    return all;
}

std::vector<SamplePacket> read(const std::filesystem::path& file) {
    StreamReader reader(file, ReadPolicy::kStrict);
    reader.follow_switches();
    std::vector<SamplePacket> all;
    SamplePacket packet;
    while (reader.next(packet)) all.push_back(packet);
    return all;
}

TEST(StreamRecorderTest, TheStreamHoldsWhatTheChipRead) {
    const TemporaryFolder folder;
    const auto video = ramp(kShape);
    const SensorSetup setup = set_up_sensor({.schedule = "tiled"}, kShape);
    StreamRecorder recorder(folder / "a.stipple", setup);
    const auto packets = record(recorder, video);
    recorder.finish();

    CodedSensor sensor(setup.params, kShape, setup.schedule.schedule, setup.seed);
    std::vector<SamplePacket> expected(kSlots);
    for (int slot = 0; slot < kSlots; ++slot)
        sensor.expose(video.frame(slot), expected[static_cast<std::size_t>(slot)]);
    EXPECT_EQ(packets, expected);
    EXPECT_EQ(read(folder / "a.stipple"), expected);
    EXPECT_EQ(recorder.samples(), sensor.stats().samples);
    // All exposures of one slot to eight, without gaps: the samples hold all light but that of
    // exposures that began before slot 0 or go on after the last.
    EXPECT_DOUBLE_EQ(recorder.emulator().light_throughput(), 1);
    EXPECT_LT(recorder.emulator().light_read(), 1);
    EXPECT_GT(recorder.emulator().light_read(), 1 - 2.0 * 8 / kSlots);
}

TEST(StreamRecorderTest, RowsThatTheReadoutHasNoTimeForAreDroppedInAPacketOfTheirOwn) {
    const TemporaryFolder folder;
    const auto video = ramp(kShape);
    const SensorSetup setup = set_up_sensor({.sensor = "lux1310",
                                             .schedule = "tiled",
                                             .settings = {"slot_us=6"},
                                             .overrun = OverrunPolicy::kDrop},
                                            kShape);
    StreamRecorder recorder(folder / "a.stipple", setup);
    const auto packets = record(recorder, video);
    recorder.finish();

    std::int64_t dropped_rows = 0, rows = 0;
    for (const SamplePacket& packet : packets) {
        rows += packet.rows;
        if ((packet.flags & SamplePacket::kDropped) == 0) continue;
        dropped_rows += packet.rows;
        EXPECT_TRUE(packet.dn.empty());
        EXPECT_EQ(packet.first_row + packet.rows, kShape.rows);
    }
    EXPECT_EQ(rows, kSlots * kShape.rows);
    EXPECT_GT(dropped_rows, 0);
    EXPECT_LT(dropped_rows, rows);
    EXPECT_EQ(recorder.samples() + recorder.emulator().readout_cost()->totals().dropped_samples,
              recorder.emulator().stats().samples);
    EXPECT_EQ(read(folder / "a.stipple"), packets);
}

/// Every third slot is not read.
std::vector<SamplePacket> record_in_part(StreamRecorder& recorder, const FluxVideo& video) {
    std::vector<SamplePacket> all;
    for (int slot = 0; slot < video.slots(); ++slot)
        for (const SamplePacket& packet : slot % 3 == 2 ? recorder.expose_unread(video.frame(slot))
                                                        : recorder.expose(video.frame(slot)))
            all.push_back(packet);
    return all;
}

void expect_others_as_they_are(const SensorChoice& choice, FrameShape shape) {
    const TemporaryFolder folder;
    const auto video = ramp(shape);
    const SensorSetup setup = set_up_sensor(choice, shape);
    StreamRecorder whole(folder / "whole.stipple", setup, {.force = true});
    StreamRecorder part(folder / "part.stipple", setup, {.force = true});
    const auto expected = record(whole, video);
    const auto packets = record_in_part(part, video);
    part.finish();
    ASSERT_EQ(packets.size(), expected.size());
    std::uint64_t samples = 0;
    double unread_light = 0;
    for (std::size_t slot = 0; slot < packets.size(); ++slot) {
        samples += packets[slot].dn.size();
        if (slot % 3 != 2) {
            EXPECT_EQ(packets[slot], expected[slot]) << choice.schedule << slot;
            continue;
        }
        const auto t = static_cast<std::int64_t>(slot);
        EXPECT_EQ(packets[slot], (SamplePacket{t, 0, kShape.rows, SamplePacket::kDropped, {}}));
        unread_light += light_due(setup.schedule.schedule, calibration_of(setup.params).tile,
                                  {t, 0, kShape.rows, kShape.cols});
    }
    EXPECT_EQ(read(folder / "part.stipple"), packets);
    EXPECT_EQ(part.samples(), samples);
    EXPECT_NEAR(whole.emulator().light_read() - part.emulator().light_read(),
                unread_light / (kSlots * static_cast<double>(kShape.pixels())), 1e-12);
    if (part.emulator().readout_cost() == nullptr) return;
    EXPECT_EQ(part.emulator().readout_cost()->slots(), kSlots);
    EXPECT_EQ(part.emulator().readout_cost()->totals().samples,
              whole.emulator().readout_cost()->totals().samples);
}

TEST(StreamRecorderTest, SlotsThatAreNotReadLeaveTheOthersAsTheyAre) {
    for (const SensorChoice& choice :
         {SensorChoice{.schedule = "random"},
          SensorChoice{.schedule = "alternating", .settings = {"charge_stores=2"}},
          SensorChoice{.sensor = "t6",
          .schedule = "tiled",
          .settings = {"lag=0.1", "row_skew_slots=0.5", "crosstalk=0.1"}},
          SensorChoice{.sensor = "lux1310", .schedule = "tiled"}})
        expect_others_as_they_are(choice, kShape);
    expect_others_as_they_are({.schedule = "random"}, {kShape.rows, kShape.cols, 3});
}

TEST(StreamRecorderTest, ColourFallsOnTheFiltersOfTheArray) {
    const TemporaryFolder folder;
    const FrameShape colour{kShape.rows, kShape.cols, 3};
    const auto video = ramp(colour);
    const SensorChoice choice{.sensor = "ideal", .schedule = "tiled", .settings = {"cfa=rggb"}};
    const SensorSetup setup = set_up_sensor(choice, colour);
    StreamRecorder recorder(folder / "colour.stipple", setup);
    FluxVideo mosaic(kSlots, kShape);
    for (int slot = 0; slot < kSlots; ++slot)
        take_mosaic(ColourFilter::kRggb, colour, video.frame(slot), mosaic.frame(slot));
    const SensorSetup grey = set_up_sensor(choice, kShape, ColourFilter::kRggb);
    StreamRecorder of_mosaic(folder / "mosaic.stipple", grey);
    EXPECT_EQ(record(recorder, video), record(of_mosaic, mosaic));
}

TEST(StreamRecorderTest, ARunThatIsGivenUpLeavesNoFile) {
    const TemporaryFolder folder;
    const SensorSetup setup = set_up_sensor({}, kShape);
    {
        StreamRecorder recorder(folder / "a.stipple", setup);
        recorder.expose(ramp(kShape).frame(0));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(StreamRecorderTest, TheHeaderSaysHowToMakeTheStreamAgain) {
    const FootageOrigin origin{.name = "clip", .sha256 = "00"};
    const SensorSetup setup =
        set_up_sensor({.schedule = "tiled", .settings = {"read_noise_e=5"}, .seed = 7}, kShape);
    EXPECT_EQ(command_of(provenance_of(setup, origin)),
              "stipple emulate clip -o again.stipple --schedule tiled --set sensor.read_noise_e=5 "
              "--seed 7");
}

TEST(StreamRecorderTest, TheHeaderHasTheFilesAsTheyWereRead) {
    const TemporaryFolder folder;
    const auto sensor = folder / "chip.toml";
    const auto schedule = folder / "plan.toml";
    const auto write = [](const std::filesystem::path& file, const std::string& text) {
        std::ofstream(file) << text;
    };
    write(sensor, "name = \"chip\"\nread_noise_e = 5\n");
    write(schedule, "kind = \"full\"\nopen_slots = 3\nperiod_slots = 4\n");
    const SensorChoice choice{.sensor = sensor.string(), .schedule = schedule.string()};
    const SensorSetup setup = set_up_sensor(choice, kShape);
    const std::string before = provenance_of(setup, {});
    write(schedule, "kind = \"full\"\nopen_slots = 2\nperiod_slots = 4\n");
    std::filesystem::remove(sensor);
    EXPECT_EQ(provenance_of(setup, {}), before);
    EXPECT_NE(before.find("open_slots = 3"), std::string::npos) << before;
}

TEST(StreamRecorderTest, TheHeaderSaysWhatWasMadeInCode) {
    const FootageOrigin origin{.name = "clip", .sha256 = "00"};
    SensorSetup setup = set_up_sensor({.schedule = "tiled"}, kShape);
    EXPECT_EQ(provenance_of(setup, origin).find("made_in_code"), std::string::npos);
    setup.schedule = {"mine", {}, ExposureSchedule(1, 1, 1, {0, 1}, {{0, open_without_gap(1)}})};
    const std::string text = provenance_of(setup, origin);
    EXPECT_NE(text.find("[schedule]\nmade_in_code = true\nname = 'mine'\n"), std::string::npos)
        << text;
    EXPECT_EQ(text.find("tiled"), std::string::npos) << text;
    EXPECT_EQ(command_of(text), "");

    setup = set_up_sensor({}, kShape);
    setup.origin.reset();
    EXPECT_EQ(command_of(provenance_of(setup, origin)), "");
}

// The chip has 1 channel, so a whole row takes 48 clocks, and 32 of them more than two slots.
TEST(StreamRecorderTest, TheSlotBeforeASwitchIsAnOverrunIfRowsWait) {
    const TemporaryFolder folder;
    const auto video = ramp(kShape);
    SensorSetup setup = set_up_sensor({.schedule = "full4x"}, kShape);
    ReadoutTiming& timing = setup.timing.emplace();
    timing.clock_hz = 1'000'000;
    timing.rows = 32;
    timing.cols = 48;
    setup.params.slot_us = 700;
    SensorSetup next = set_up_sensor({.schedule = "tiled"}, kShape);
    next.timing = setup.timing;
    next.params.slot_us = setup.params.slot_us;
    // Frames of 4 slots are read after slots 3, 7, ..., and take three slots.
    for (const int slot : {4, 5, 6, 7}) {
        const std::string name = "a" + std::to_string(slot) + ".stipple";
        StreamRecorder recorder(folder / name, setup, {.may_switch = true});
        for (int i = 0; i < 12; ++i) {
            if (i == slot) recorder.switch_to(next);
            recorder.expose(video.frame(i));
        }
        recorder.finish();
        const auto packets = read(folder / name);
        ASSERT_EQ(packets.size(), 12U);
        EXPECT_EQ(packets[static_cast<std::size_t>(slot - 1)].flags,
                  slot < 6 ? SamplePacket::kOverrun : 0)
            << slot;
    }
}

}  // namespace
}  // namespace stipple
