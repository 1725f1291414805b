#include "capture/live_emulator.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <semaphore>

#include "readout/emulator.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "stream/stream_reader.h"
#include "tests/capture/scripted_session.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class LiveEmulatorTest : public ::testing::Test {
  protected:
    /// A camera that sends frames with these ids, each of light of its own, and is then gone.
    LiveEmulation emulate(const std::vector<std::uint64_t>& wire_ids,
                          LiveEmulatorOptions options = {}) {
        return emulate(frames(wire_ids), std::move(options));
    }
    LiveEmulation emulate(std::deque<ScriptedStep> steps, LiveEmulatorOptions options,
                          std::size_t waiting_frames = 64) {
        steps.push_back(is_lost("unplugged"));
        LiveCamera camera(plays({std::move(steps)}), {.session = SessionOptions{.reconnect = false},
                                                      .waiting_frames = waiting_frames,
                                                      .from_start = true,
                                                      .tell = [](const SessionEvent&) {}});
        options.show = [this](const LiveSlot& slot) {
            shown_.insert(shown_.end(), slot.packets.begin(), slot.packets.end());
            if (after_show_) after_show_();
        };
        LiveEmulator emulator(camera, to_light_, recorder_, std::move(options));
        LiveEmulation result = emulator.run([](const LiveEmulation&) { return true; });
        camera.stop();
        recorder_.finish();
        return result;
    }
    /// What the emulated sensor makes of frames with these ids.
    std::vector<SamplePacket> expected(const std::vector<std::uint64_t>& wire_ids) {
        Emulator emulator(setup_);
        std::vector<float> light(to_light_.shape().sites());
        std::vector<SamplePacket> packets;
        for (const std::uint64_t id : wire_ids) {
            to_light_.convert(scripted_frame(id).payload, light);
            const auto slot = emulator.expose(light);
            packets.insert(packets.end(), slot.begin(), slot.end());
        }
        return packets;
    }

    TemporaryFolder folder_;
    FrameLight to_light_{scripted_layout(), 0};
    SensorSetup setup_ = set_up_sensor({.schedule = "full1x"}, to_light_.shape());
    StreamRecorder recorder_{
        folder_ / "live.stipple", setup_, {.provenance = provenance_of(setup_, {})}};
    std::vector<SamplePacket> shown_;
    std::function<void()> after_show_;
};

TEST_F(LiveEmulatorTest, EachFrameIsASlot) {
    const std::vector<std::uint64_t> ids{10, 11, 12, 13, 14, 15, 16, 17};
    const LiveEmulation result = emulate(ids);
    EXPECT_EQ(shown_, expected(ids));
    EXPECT_EQ(result.latencies.count(), 8U);
    EXPECT_EQ(result.held_slots, 0U);
    ASSERT_TRUE(result.end);
    EXPECT_EQ(result.end->reason, "camera lost: unplugged");
    EXPECT_FALSE(result.failure);
    StreamReader reader(folder_ / "live.stipple");
    std::vector<SamplePacket> recorded;
    for (SamplePacket packet; reader.next(packet);) recorded.push_back(packet);
    EXPECT_EQ(recorded, shown_);
}

TEST_F(LiveEmulatorTest, TheFrameBeforeStandsInForWhatIsMissing) {
    const LiveEmulation result = emulate({10, 11, 14, 15});
    EXPECT_EQ(shown_, expected({10, 11, 11, 11, 14, 15}));
    EXPECT_EQ(result.held_slots, 2U);
    EXPECT_EQ(result.latencies.count(), 4U);
    EXPECT_EQ(std::accumulate(result.totals.lost.begin(), result.totals.lost.end(), 0U), 2U);
}

// While the first slot is emulated, frame 11 fills the queue, and 12, 13 and 14 find no room.
TEST_F(LiveEmulatorTest, SlotsOfAFullQueueHaveNoSamples) {
    std::binary_semaphore begun{0}, full{0}, room{0};
    after_show_ = [&] {
        if (shown_.size() == 1) {
            begun.release();
            full.acquire();
        } else if (shown_.size() == 2) {
            room.release();
        }
    };
    std::deque<ScriptedStep> steps = frames({10, 11, 12, 13, 14, 15});
    const auto before = [](ScriptedStep& step, const std::function<void()>& action) {
        step.arrival = [action, arrival = step.arrival] {
            action();
            return arrival();
        };
    };
    before(steps[1], [&] { begun.acquire(); });
    before(steps[5], [&] {
        full.release();
        room.acquire();
    });
    const LiveEmulation result = emulate(std::move(steps), {}, 1);
    auto packets = expected({10, 11, 11, 11, 11, 15});
    for (std::size_t slot = 2; slot < 5; ++slot) {
        packets[slot].flags = SamplePacket::kDropped;
        packets[slot].dn.clear();
    }
    EXPECT_EQ(shown_, packets);
    EXPECT_EQ(result.held_slots, 3U);
    EXPECT_EQ(result.dropped_slots, 3U);
    EXPECT_EQ(result.totals.lost[static_cast<std::size_t>(GapCause::kQueueDrop)], 3U);
}

// Slot 0 is the first whole frame: what is missing before it has no slot, but a count.
TEST_F(LiveEmulatorTest, WhatIsMissingBeforeTheFirstSlotIsCountedApart) {
    CapturedFrame half = scripted_frame(10);
    half.record.status = FrameStatus::kMissingPackets;
    half.holes = {{0, 4}};
    const LiveEmulation result =
        emulate({arrives(half), arrives(scripted_frame(13)), arrives(scripted_frame(15))}, {});
    EXPECT_EQ(shown_, expected({13, 13, 15}));
    EXPECT_EQ(result.totals.missing_before_first, 3U);
    EXPECT_EQ(result.totals.incomplete, 0U);
    EXPECT_EQ(result.held_slots, 1U);
    EXPECT_EQ(std::accumulate(result.totals.lost.begin(), result.totals.lost.end(), 0U), 1U);
}

TEST_F(LiveEmulatorTest, ALimitEndsIt) {
    const LiveEmulation result = emulate({10, 11, 12, 13}, {.limits = {.frames = 3}});
    EXPECT_EQ(shown_, expected({10, 11, 12}));
    EXPECT_FALSE(result.end);
}

// max_missing_slots: 16 for each of 2 frames, and 1000.
TEST_F(LiveEmulatorTest, SlotsWithoutProportionAreLeftOutAndTold) {
    std::vector<LeftOut> told;
    const LiveEmulation result =
        emulate({10, 20'000}, {.tell = [&](const LeftOut& left_out) { told.push_back(left_out); }});
    EXPECT_EQ(result.held_slots, 1032U);
    EXPECT_EQ(result.unheld_slots, 19'989U - 1032U);
    EXPECT_EQ(recorder_.emulator().stats().slots, 1034);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].missing, 19'989U);
    EXPECT_EQ(told[0].held, 1032U);
    EXPECT_EQ(told[0].first_slot, 1033);
}

// Scripted frames came long ago.
TEST_F(LiveEmulatorTest, SlotsThatAreLateAreCountedAndListed) {
    const LiveEmulation result = emulate({10, 11, 12});
    EXPECT_EQ(result.late_slots, 3U);
    ASSERT_EQ(result.late.size(), 3U);
    EXPECT_EQ(result.late[2].slot, 2);
    EXPECT_EQ(result.late[2].arrival_ns, 60'000'000);
    EXPECT_GT(result.late[2].latency_us, 2 * setup_.params.slot_us);
}

}  // namespace
}  // namespace stipple
