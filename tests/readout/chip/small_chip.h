#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "readout/chip/register_chip.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "readout/stream_recorder.h"
#include "stream/stream_reader.h"
#include "tests/support/temporary_folder.h"

namespace stipple {

constexpr int kFrames = 7;  ///< of the footage, which the chip repeats
constexpr FrameShape kArray{.rows = 8, .cols = 12};

/// 2 channels: a row of n columns takes 3 + max(5, n / 2) clocks or so.
inline SensorSetup small_sensor(const std::string& schedule,
                                const std::vector<std::string>& keys = {}) {
    SensorSetup setup = set_up_sensor({.schedule = schedule, .schedule_settings = keys}, kArray);
    ReadoutTiming& timing = setup.timing.emplace();
    timing.clock_hz = 1'000'000;
    timing.rows = kArray.rows;
    timing.cols = kArray.cols;
    timing.addressing.channels = 2;
    timing.rot_clocks = 3;
    timing.adc_clocks = 5;
    timing.io_clocks = 1;
    setup.params.slot_us = 40;
    return setup;
}

inline std::vector<float> frame_of(int number, std::size_t sites) {
    std::vector<float> frame(sites);
    for (std::size_t i = 0; i < sites; ++i)
        frame[i] =
            std::fmod(0.13F * static_cast<float>(i) + 0.29F * static_cast<float>(number), 2.0F);
    return frame;
}

inline OpenLight repeated_light() {
    return [] {
        return [number = 0, frame = std::vector<float>()]() mutable -> std::span<const float> {
            if (number == kFrames) return {};
            frame = frame_of(number++, kArray.pixels());
            return frame;
        };
    };
}

struct Recorded {
    bool may_switch = false;
    std::vector<ScheduleSwitch> switches;
    std::vector<SamplePacket> packets;
};

inline Recorded read_stream(const std::filesystem::path& file) {
    StreamReader reader(file, ReadPolicy::kStrict);
    reader.follow_switches();
    Recorded recorded;
    for (SamplePacket packet; reader.next(packet);) recorded.packets.push_back(packet);
    recorded.may_switch = reader.header().may_switch;
    recorded.switches = reader.header().switches;
    return recorded;
}

class SmallChipTest : public testing::Test {
  protected:
    RegisterChip preset_chip(const SensorSetup& setup) {
        RegisterChip chip(setup, geometry_of(setup),
                          {.output = folder_ / "a.stipple", .open_light = repeated_light()});
        chip.preset();
        return chip;
    }
    /// The stream that the emulator makes of the first slots, its sensor changed at one of them.
    Recorded emulated(const SensorSetup& setup, int slots, const SensorSetup* next = nullptr,
                      std::int64_t at = 0) {
        const std::filesystem::path file = folder_ / "expected.stipple";
        StreamRecorder recorder(file, setup, {.force = true, .may_switch = next != nullptr});
        for (int slot = 0; slot < slots; ++slot) {
            if (next != nullptr && slot == at) recorder.switch_to(*next);
            recorder.expose(frame_of(slot % kFrames, setup.footage.sites()));
        }
        recorder.finish();
        return read_stream(file);
    }
    TemporaryFolder folder_;
};

inline void set(RegisterChip& chip, std::uint32_t address, std::uint32_t value) {
    EXPECT_TRUE(chip.write(address, value)) << register_name(address);
}

inline std::uint32_t get(RegisterChip& chip, std::uint32_t address) {
    return chip.read(address).value_or(0xDEAD);
}

constexpr std::uint32_t kStart = STIPPLE_CONTROL_START;

}  // namespace stipple
