#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <thread>

#include "tests/capture/scripted_session.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

/// With the stamp of a device clock.
CapturedFrame stamped_frame(std::uint64_t wire_id, std::int64_t device_ns) {
    CapturedFrame frame = scripted_frame(wire_id);
    frame.record.device_ns = device_ns;
    frame.record.stamp_source = StampSource::kDeviceClock;
    return frame;
}

/// What a camera sends on purpose, and what of that comes again.
struct RandomScript {
    std::deque<ScriptedStep> steps;
    std::vector<std::uint64_t> wire_ids;  ///< without repeats
    std::uint64_t lost = 0;
    std::uint64_t repeated = 0;
    std::uint32_t restarts = 0;
};

RandomScript random_script(std::mt19937& random, bool stamps, bool restarts) {
    RandomScript script;
    std::vector<CapturedFrame> sent;  // since the counter began
    std::uint64_t wire_id = 65000;
    const auto move = [&](std::uint64_t steps) { wire_id = (wire_id - 1 + steps) % 65535 + 1; };
    const auto send = [&] {
        sent.push_back(stamps ? stamped_frame(wire_id, static_cast<std::int64_t>(sent.size()) + 1)
                              : scripted_frame(wire_id));
        script.wire_ids.push_back(wire_id);
        script.steps.push_back(arrives(sent.back()));
    };
    send();
    for (int i = 0; i < 300; ++i) {
        if (restarts && sent.size() > 20 && random() % 40 == 0) {
            // The clock, too: nothing but the second frame tells.
            ++script.restarts;
            sent.clear();
            move(65535 - 15);
            send();
            move(1);
            send();
            continue;
        }
        // One frame again, once or more often; the last one only where stamps tell.
        if (const std::size_t known = sent.size() - (stamps ? 0 : 1);
            random() % 3 == 0 && known > 0) {
            const CapturedFrame again = sent[random() % known];
            for (std::uint64_t times = random() % 3 + 1; times > 0; --times, ++script.repeated)
                script.steps.push_back(arrives(again));
        }
        const std::uint64_t gap = random() % 4 == 0 ? random() % 5 : 0;
        script.lost += gap;
        move(1 + gap);
        send();
    }
    return script;
}

TEST(RepeatedFramesTest, FramesThatComeAgainAreLeftOutUnlessTheCounterRestarts) {
    constexpr unsigned kSeed = 20261122;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (int round = 0; round < 40; ++round) {
        const bool stamps = round % 2 == 0;
        const bool restarts = round % 4 < 2;
        const RandomScript script = random_script(random, stamps, restarts);
        CaptureSession session(plays({script.steps}), {.stall = 0ms});
        std::optional<FrameRecord> last;
        for (const std::uint64_t wire_id : script.wire_ids) {
            const FrameRecord record = next_record(session);
            ASSERT_EQ(record.wire_id, wire_id);
            if (last) {
                ASSERT_EQ(record.id, last->id + 1 + record.lost_before);
            }
            last = record;
        }
        EXPECT_EQ(last->epoch, script.restarts);
        EXPECT_EQ(lost(session, GapCause::kDevice), script.lost);
        EXPECT_EQ(session.totals().repeated, script.repeated);
        EXPECT_EQ(session.totals().frames, script.wire_ids.size());
    }
}

TEST(RepeatedFramesTest, ACounterThatBeginsAnewIsKnownAtOnceByItsStamp) {
    CaptureSession session(
        plays({{arrives(stamped_frame(500, 1000)), arrives(stamped_frame(1, 1005))}}), {});
    static_cast<void>(next_record(session));
    const FrameRecord record = next_record(session);
    EXPECT_EQ(record.epoch, 1U);
    EXPECT_EQ(record.id, 1U);
    EXPECT_EQ(record.lost_before, 0U);
}

TEST(RepeatedFramesTest, ACameraWhoseCounterStandsRepeatsNothing) {
    CaptureSession still(plays({frames({7, 7, 7})}), {});
    for (std::uint64_t id = 0; id < 3; ++id) EXPECT_EQ(next_record(still).id, id);
    EXPECT_EQ(still.totals().repeated, 0U);
}

TEST(RepeatedFramesTest, ACameraThatOnlyRepeatsItselfIsOpenedAnew) {
    std::deque<ScriptedStep> script = frames({5, 6});
    for (int i = 0; i < 1000; ++i) {
        script.push_back(arrives(scripted_frame(5)));
        script.push_back({[] {
                              std::this_thread::sleep_for(1ms);
                              return Arrival(NoFrame{});
                          },
                          {}});
    }
    CaptureSession session(plays({script, frames({1})}), {.stall = 20ms});
    for (int i = 0; i < 2; ++i) static_cast<void>(next_record(session));
    static_cast<void>(wait_for<Outage>(session));
    EXPECT_GT(session.totals().repeated, 0U);
    EXPECT_LT(session.totals().repeated, 1000U);
    static_cast<void>(wait_for<Recovery>(session));
    EXPECT_EQ(next_record(session).wire_id, 1U);
}

}  // namespace
}  // namespace stipple
