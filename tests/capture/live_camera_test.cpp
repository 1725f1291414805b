#include "capture/live_camera.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <thread>

#include "core/error.h"
#include "core/memory_limit.h"
#include "tests/capture/scripted_session.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using std::chrono::milliseconds;

/// What test and camera tell one another.
struct Script {
    std::atomic<std::uint64_t> allowed = 0;     ///< frames that may be sent
    std::atomic<std::uint64_t> asked = 0;       ///< waits in vain after the last of them
    std::set<const std::uint8_t*> places = {};  ///< of the payloads; the camera's, until the end
    FrameStatus status = FrameStatus::kComplete;
    bool repeats = false;  ///< each frame comes twice
    std::size_t buffer_bytes = 0;
};

/// Sends frames as fast as they are taken, as far as its script allows.
class FastCamera : public Camera {
  public:
    explicit FastCamera(Script& script) : script_(script) {}

    [[nodiscard]] CameraDescription description() const override { return {}; }
    [[nodiscard]] FrameLayout layout() const override { return scripted_layout(); }
    [[nodiscard]] std::size_t buffer_bytes() const override { return script_.buffer_bytes; }
    [[nodiscard]] std::uint64_t wire_id_period() const override { return 65535; }
    [[nodiscard]] TransportCounts counts() const override { return {}; }
    void start() override {}
    [[nodiscard]] Arrival wait(milliseconds) override {
        if (sent_ == script_.allowed) {
            ++script_.asked;
            std::this_thread::sleep_for(milliseconds(1));
            return NoFrame{};
        }
        ++sent_;
        CapturedFrame frame = scripted_frame(script_.repeats ? (sent_ + 1) / 2 : sent_);
        frame.record.stamp_source = StampSource::kDeviceClock;
        frame.record.device_ns = static_cast<std::int64_t>(frame.record.wire_id);
        frame.record.status = script_.status;
        const auto content = std::exchange(frame.payload, pool().take());
        frame.payload.assign(content.begin(), content.end());
        script_.places.insert(frame.payload.data());
        return frame;
    }
    void stop() noexcept override {}

  private:
    Script& script_;
    std::uint64_t sent_ = 0;
};

class LiveCameraTest : public ::testing::Test {
  protected:
    CaptureSession::Opener opener() {
        return [this] { return std::make_unique<FastCamera>(script_); };
    }
    LiveCamera open(std::size_t waiting_frames, bool from_start = true) {
        return {opener(),
                {.session = SessionOptions{.stall = milliseconds(0)},
                 .waiting_frames = waiting_frames,
                 .from_start = from_start,
                 .tell = [](const SessionEvent&) {}}};
    }
    /// Lets so many frames come, and waits until all have been received.
    void send(std::uint64_t frames) {
        script_.allowed += frames;
        const std::uint64_t asked = script_.asked;
        while (script_.asked < asked + 2) std::this_thread::yield();
    }

    Script script_;
};

TEST_F(LiveCameraTest, AConsumerThatStandsStillCostsFramesButNoMemory) {
    constexpr std::size_t kWaiting = 8;
    LiveCamera camera = open(kWaiting);
    camera.begin();
    std::set<const std::uint8_t*> places;
    CapturedFrame frame;
    std::uint64_t taken = 0;
    for (int burst = 0; burst < 3; ++burst) {
        send(50);
        for (; camera.next(frame, milliseconds(0)); ++taken) places.insert(frame.payload.data());
    }
    EXPECT_EQ(taken, 3 * kWaiting);
    EXPECT_EQ(camera.peak(), kWaiting);
    EXPECT_EQ(camera.late_allocations(), 0U);
    const SessionTotals totals = camera.stop();
    EXPECT_EQ(totals.lost[static_cast<std::size_t>(GapCause::kQueueDrop)], 150 - taken);
    // Each frame lies where the camera has put it, in one of the places of the pool.
    EXPECT_LE(script_.places.size(), kWaiting + 1 + CaptureSession::kOwnFrames);
    for (const std::uint8_t* const place : places) EXPECT_TRUE(script_.places.contains(place));
}

TEST_F(LiveCameraTest, FramesBeforeTheBeginAreDiscardedAndCostNoMemory) {
    LiveCamera camera = open(2, false);
    send(100);
    camera.begin();
    send(1);
    CapturedFrame frame;
    EXPECT_TRUE(camera.next(frame, kLong));
    EXPECT_EQ(frame.record.wire_id, 101U);
    EXPECT_EQ(camera.late_allocations(), 0U);
}

// 12 frames of 8 bytes: the session holds up to 3 and the caller 1.
TEST_F(LiveCameraTest, MaxMemoryBoundsTheFramesThatWait) {
    const MemoryLimit limit(100);
    LiveCamera camera = open(64);
    camera.begin();
    send(50);
    EXPECT_EQ(camera.peak(), 8U);
    ASSERT_EQ(camera.description().warnings.size(), 1U);
    expect_parts(camera.description().warnings[0].text(),
                 {"8 frames may wait, not 64", "max_memory"});
}

// 24 bytes of buffers leave room for 9 frames of 8 bytes.
TEST_F(LiveCameraTest, MaxMemoryBoundsBuffersAndFramesTogether) {
    script_.buffer_bytes = 24;
    const MemoryLimit limit(100);
    LiveCamera camera = open(64);
    camera.begin();
    send(50);
    EXPECT_EQ(camera.peak(), 5U);
}

TEST_F(LiveCameraTest, NoRoomForAFrameIsAnErrorThatNamesBothParts) {
    script_.buffer_bytes = 1'000'000;
    const MemoryLimit limit(1'000'039);
    expect_parts(message_of<InputError>([&] {
                     const LiveCamera camera = open(64);
                     return 0;
                 }),
                 {"buffers of the camera (1.0 MB)", "5 frames", "max_memory = "});
    const MemoryLimit more(1'000'040);
    const LiveCamera camera = open(64);
}

TEST_F(LiveCameraTest, FramesThatTheSessionDropsGiveTheirMemoryBack) {
    for (const bool repeats : {false, true}) {
        script_.repeats = repeats;
        script_.status = repeats ? FrameStatus::kComplete : FrameStatus::kMissingPackets;
        script_.allowed = 0;
        CaptureSession session(opener(),
                               {.incomplete = IncompletePolicy::kDrop, .stall = milliseconds(0)},
                               [](const Camera&) { return 1U; });
        script_.allowed = 100;
        const std::uint64_t asked = script_.asked;
        while (script_.asked == asked) {
            auto event = session.next(milliseconds(1));
            if (auto* const frame = std::get_if<CapturedFrame>(&event))
                session.give_back(std::move(frame->payload));
        }
        EXPECT_EQ(session.totals().frames, repeats ? 50U : 0U);
        EXPECT_EQ(session.late_allocations(), 0U);
    }
}

}  // namespace
}  // namespace stipple
