#include "capture/capture_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "core/error.h"
#include "tests/capture/scripted_session.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

CapturedFrame incomplete(std::uint64_t wire_id, bool with_holes = true) {
    CapturedFrame frame = scripted_frame(wire_id);
    frame.record.status = FrameStatus::kMissingPackets;
    if (with_holes) frame.holes = {{0, 4}};
    return frame;
}

TEST(CaptureSessionTest, FramesThatFollowEachOtherHaveNoGap) {
    CaptureSession session(plays({frames({65534, 65535, 1, 2})}), {});
    for (std::uint64_t id = 0; id < 4; ++id) {
        const FrameRecord record = next_record(session);
        EXPECT_EQ(record.id, id);
        EXPECT_EQ(record.lost_before, 0U);
        EXPECT_EQ(record.cause, GapCause::kNone);
        EXPECT_EQ(record.epoch, 0U);
    }
    EXPECT_EQ(session.totals().frames, 4U);
}

TEST(CaptureSessionTest, IdsThatNothingExplainsWereLeftOutByTheCamera) {
    CaptureSession session(plays({frames({1, 5})}), {});
    static_cast<void>(next_record(session));
    const FrameRecord record = next_record(session);
    EXPECT_EQ(record.id, 4U);
    EXPECT_EQ(record.lost_before, 3U);
    EXPECT_EQ(record.cause, GapCause::kDevice);
    EXPECT_EQ(lost(session, GapCause::kDevice), 3U);
}

/// A GigE Vision camera of 100 frames/s, whose first frame comes `ms` after it is opened.
CaptureSession::Opener begins_with(std::uint64_t wire_id, std::int64_t ms,
                                   const TransportCounts& counts = {}) {
    return [=] {
        CapturedFrame first = scripted_frame(wire_id);
        first.record.host_monotonic_ns = ms * 1'000'000;
        CameraDescription description;
        description.features["AcquisitionFrameRate"] = "100";
        auto camera = std::make_unique<ScriptedCamera>(
            std::deque{arrives(first, counts), arrives(scripted_frame(wire_id + 1), counts)},
            description);
        camera->begin = {.first_wire_id = 1, .monotonic_ns = 0};
        return camera;
    };
}

TEST(CaptureSessionTest, FramesLostBeforeTheFirstAreMissingBeforeIt) {
    CaptureSession session(begins_with(6, 51, {.socket_drops = 30}), {});
    const FrameRecord first = next_record(session);
    EXPECT_EQ(first.id, 5U);
    EXPECT_EQ(first.lost_before, 5U);
    EXPECT_EQ(first.cause, GapCause::kTransport);
    EXPECT_EQ(first.epoch, 0U);
    const FrameRecord second = next_record(session);
    EXPECT_EQ(second.id, 6U);
    EXPECT_EQ(second.lost_before, 0U);
    EXPECT_EQ(lost(session, GapCause::kTransport), 5U);
    EXPECT_EQ(session.totals().missing_before_first, 5U);
}

TEST(CaptureSessionTest, NothingIsLostByACameraWhoseIdsBeginElsewhere) {
    for (const std::uint64_t id : {6U, 65000U}) {
        CaptureSession session(begins_with(id, 20), {});
        EXPECT_EQ(next_record(session).lost_before, 0U);
        EXPECT_EQ(next_record(session).id, 1U);
        EXPECT_EQ(session.totals().missing_before_first, 0U);
    }
}

TEST(CaptureSessionTest, AFirstFrameThatTheQueueRefusedIsMissingBeforeTheNext) {
    CaptureSession session(begins_with(6, 51), {});
    session.count_queue_drop(next_record(session));
    EXPECT_EQ(next_record(session).lost_before, 6U);
    EXPECT_EQ(session.totals().missing_before_first, 6U);
}

TEST(CaptureSessionTest, TheCauseOfAGapIsWhatTheTransportCountedMeanwhile) {
    struct Case {
        TransportCounts counts;
        GapCause cause;
    };
    for (const Case& one : {Case{{.underruns = 1}, GapCause::kHostUnderrun},
                            Case{{.packets_missing = 7}, GapCause::kTransport},
                            Case{{.socket_drops = 2}, GapCause::kTransport},
                            Case{{.link_faults = 1}, GapCause::kTransport},
                            Case{{.underruns = 1, .socket_drops = 1}, GapCause::kHostUnderrun},
                            Case{{.packets_resent = 9}, GapCause::kDevice}}) {
        CaptureSession session(
            plays({{arrives(scripted_frame(1)), arrives(scripted_frame(3), one.counts)}}), {});
        static_cast<void>(next_record(session));
        EXPECT_EQ(next_record(session).cause, one.cause);
        EXPECT_EQ(lost(session, one.cause), 1U);
    }
}

TEST(CaptureSessionTest, AnUnderrunExplainsTheGapBehindTheFramesThatWaited) {
    const TransportCounts starved{.underruns = 1};
    // Long enough for the transport's counters to be read before the gap.
    const auto slow = [] {
        std::this_thread::sleep_for(250ms);
        return Arrival(scripted_frame(2));
    };
    std::deque<ScriptedStep> script{arrives(scripted_frame(1)), {slow, starved}};
    for (const std::uint64_t id : {3U, 5U, 6U, 8U})
        script.push_back(arrives(scripted_frame(id), starved));
    CaptureSession session(plays({script}), {.stall = 0ms});
    for (int i = 0; i < 3; ++i) EXPECT_EQ(next_record(session).cause, GapCause::kNone);
    EXPECT_EQ(next_record(session).cause, GapCause::kHostUnderrun);
    EXPECT_EQ(next_record(session).cause, GapCause::kNone);
    EXPECT_EQ(next_record(session).cause, GapCause::kDevice);  // explained by nothing new
}

TEST(CaptureSessionTest, PacketsOfAFrameThatArrivedIncompleteExplainNoOtherFrame) {
    const TransportCounts missing{.packets_missing = 2};
    CaptureSession session(plays({{arrives(scripted_frame(1)), arrives(incomplete(2), missing),
                                   arrives(scripted_frame(4), missing)}}),
                           {});
    for (int i = 0; i < 2; ++i) static_cast<void>(next_record(session));
    EXPECT_EQ(next_record(session).cause, GapCause::kDevice);
}

TEST(CaptureSessionTest, ADroppedFrameIsLostByWhatMadeItIncomplete) {
    for (const auto& [status, cause] :
         {std::pair(FrameStatus::kMissingPackets, GapCause::kTransport),
          std::pair(FrameStatus::kSizeMismatch, GapCause::kTransport),
          std::pair(FrameStatus::kDeviceError, GapCause::kDevice),
          std::pair(FrameStatus::kOtherLayout, GapCause::kLayout)}) {
        CapturedFrame dropped = incomplete(2, false);
        dropped.record.status = status;
        CaptureSession session(
            plays({{arrives(scripted_frame(1)), arrives(std::move(dropped)),
                    arrives(scripted_frame(3))}}),
            {.incomplete = status == FrameStatus::kOtherLayout ? IncompletePolicy::kKeep
                                                               : IncompletePolicy::kDrop});
        static_cast<void>(next_record(session));
        EXPECT_EQ(next_record(session).cause, cause);
        EXPECT_EQ(lost(session, cause), 1U);
    }
}

TEST(CaptureSessionTest, EachPolicyAccountsForIncompleteFrames) {
    const std::deque<ScriptedStep> script{arrives(scripted_frame(1)), arrives(incomplete(2)),
                                          arrives(incomplete(3, false)),
                                          arrives(scripted_frame(4))};
    struct Case {
        IncompletePolicy policy;
        std::uint64_t frames;
        std::uint64_t dropped;
    };
    for (const Case& one :
         {Case{IncompletePolicy::kDrop, 2, 2}, Case{IncompletePolicy::kMask, 3, 1},
          Case{IncompletePolicy::kKeep, 4, 0}}) {
        SCOPED_TRACE(static_cast<int>(one.policy));
        CaptureSession session(plays({script}), {.incomplete = one.policy});
        std::uint64_t previous = next_record(session).id;
        for (std::uint64_t i = 1; i < one.frames; ++i) {
            const CapturedFrame frame = wait_for<CapturedFrame>(session);
            EXPECT_EQ(frame.record.id, previous + 1 + frame.record.lost_before);
            EXPECT_EQ(frame.record.cause,
                      frame.record.lost_before == 0 ? GapCause::kNone : GapCause::kTransport);
            EXPECT_EQ(frame.holes.empty(), one.policy == IncompletePolicy::kKeep ||
                                               frame.record.status == FrameStatus::kComplete);
            previous = frame.record.id;
        }
        EXPECT_EQ(previous, 3U);
        EXPECT_EQ(lost(session, GapCause::kTransport), one.dropped);
        EXPECT_EQ(session.totals().frames, one.frames);
        EXPECT_EQ(session.totals().incomplete, one.frames - 2);
    }
}

TEST(CaptureSessionTest, ALatePacketOfAFrameThatWasAccountedForIsNoFrame) {
    CaptureSession session(
        plays({{arrives(scripted_frame(40)), arrives(incomplete(41)), arrives(scripted_frame(42)),
                arrives(incomplete(41)), arrives(scripted_frame(43))}}),
        {});
    for (std::uint64_t id = 0; id < 4; ++id) {
        const FrameRecord record = next_record(session);
        EXPECT_EQ(record.id, id);
        EXPECT_EQ(record.epoch, 0U);
        EXPECT_EQ(record.lost_before, 0U);
    }
    EXPECT_EQ(session.totals().frames, 4U);
}

TEST(CaptureSessionTest, AFrameThatTheQueueRefusedIsMissingBeforeTheNext) {
    CaptureSession session(plays({frames({1, 3, 4})}), {});
    static_cast<void>(next_record(session));
    session.count_queue_drop(next_record(session));
    const FrameRecord record = next_record(session);
    EXPECT_EQ(record.id, 3U);
    EXPECT_EQ(record.lost_before, 2U);  // one of the camera, one of ours
    EXPECT_EQ(lost(session, GapCause::kDevice), 1U);
    EXPECT_EQ(lost(session, GapCause::kQueueDrop), 1U);
    EXPECT_EQ(session.totals().frames, 2U);
}

TEST(CaptureSessionTest, AnotherLayoutBeginsAnEpoch) {
    CapturedFrame wide = scripted_frame(2);
    wide.record.layout = scripted_layout(8);
    CaptureSession session(plays({{arrives(scripted_frame(1)), arrives(wide)}}), {});
    EXPECT_EQ(next_record(session).epoch, 0U);
    EXPECT_EQ(next_record(session).epoch, 1U);
    EXPECT_EQ(session.layout().width, 8);
}

TEST(CaptureSessionTest, AClockThatIsSetBackBeginsAnEpochAndScatterOfStampsDoesNot) {
    std::deque<ScriptedStep> script;
    for (const int device_ms : {900, 910, 909, 920, 0, 10}) {
        const auto count = static_cast<std::int64_t>(script.size());
        CapturedFrame frame = scripted_frame(static_cast<std::uint64_t>(count) + 1, 10 * count);
        frame.record.stamp_source = StampSource::kDeviceClock;
        frame.record.device_ns = device_ms * 1'000'000;
        script.push_back(arrives(frame));
    }
    CaptureSession session(plays({script}), {});
    for (const std::uint32_t epoch : {0U, 0U, 0U, 0U, 1U, 1U})
        EXPECT_EQ(next_record(session).epoch, epoch);
    EXPECT_EQ(session.totals().outages, 0U);
}

TEST(CaptureSessionTest, ACameraThatFallsSilentIsOpenedAnew) {
    CaptureSession session(plays({frames({100, 101, 102}), frames({1, 2})}), {.stall = 20ms});
    for (int i = 0; i < 3; ++i) static_cast<void>(next_record(session));
    const auto outage = wait_for<Outage>(session);
    EXPECT_NE(outage.reason.find("nothing came for"), std::string::npos);
    EXPECT_GE(wait_for<Recovery>(session).gone_s, 0.02);
    const FrameRecord record = next_record(session);
    EXPECT_EQ(record.epoch, 1U);
    EXPECT_EQ(record.wire_id, 1U);
    EXPECT_EQ(next_record(session).epoch, 1U);
    EXPECT_EQ(session.totals().outages, 1U);
}

// The program is stopped, or the machine: frames that came meanwhile wait to be received.
TEST(CaptureSessionTest, APauseOfTheProgramIsNoSilenceOfTheCamera) {
    const auto pause = [] {
        std::this_thread::sleep_for(100ms);
        return Arrival(NoFrame{});
    };
    CaptureSession session(
        plays({{arrives(scripted_frame(1)), {pause, {}}, arrives(scripted_frame(2))}}),
        {.stall = 20ms});
    static_cast<void>(next_record(session));
    EXPECT_TRUE(std::holds_alternative<NoFrame>(session.next(5ms)));
    EXPECT_EQ(next_record(session).wire_id, 2U);
    EXPECT_EQ(session.totals().outages, 0U);
}

TEST(CaptureSessionTest, FramesOfAnOutageAreEstimatedFromTheFramePeriod) {
    CameraDescription camera;
    camera.features["AcquisitionFrameRate"] = "100";  // 10 ms
    CaptureSession session(plays({{arrives(scripted_frame(7, 0)), is_lost("unplugged")},
                                  {arrives(scripted_frame(1, 500))}},
                                 camera),
                           {});
    EXPECT_EQ(next_record(session).id, 0U);
    EXPECT_EQ(wait_for<Outage>(session).reason, "unplugged");
    static_cast<void>(wait_for<Recovery>(session));
    const FrameRecord record = next_record(session);
    EXPECT_EQ(record.lost_before, 49U);  // 500 ms / 10 ms - 1
    EXPECT_EQ(record.id, 50U);
    EXPECT_EQ(record.cause, GapCause::kReconnect);
    EXPECT_EQ(lost(session, GapCause::kReconnect), 49U);
}

TEST(CaptureSessionTest, ACameraThatIsLostTwiceKeepsThePeriodOfItsFrames) {
    CaptureSession session(plays({{arrives(scripted_frame(7, 0)), arrives(scripted_frame(8, 10)),
                                   is_lost("unplugged")},
                                  {is_lost("unplugged again")},
                                  {arrives(scripted_frame(1, 500))}}),
                           {});
    for (int i = 0; i < 2; ++i) static_cast<void>(next_record(session));
    for (int i = 0; i < 2; ++i) {
        static_cast<void>(wait_for<Outage>(session));
        static_cast<void>(wait_for<Recovery>(session));
    }
    EXPECT_EQ(next_record(session).lost_before, 48U);  // 490 ms / 10 ms - 1
    EXPECT_EQ(session.totals().outages, 2U);
}

TEST(CaptureSessionTest, ASlowCameraIsNotTakenForASilentOne) {
    CameraDescription camera;
    camera.features["AcquisitionFrameRate"] = "0.01";  // five periods: 500 s
    std::deque<ScriptedStep> script = frames({1});
    CaptureSession session(plays({script}, camera), {.stall = 1ms});
    static_cast<void>(next_record(session));
    EXPECT_TRUE(std::holds_alternative<NoFrame>(session.next(50ms)));
}

TEST(CaptureSessionTest, ACameraThatWaitsForTriggersMayBeSilent) {
    CameraDescription camera;
    camera.features["TriggerMode"] = "On";
    CaptureSession session(plays({frames({1})}, camera), {.stall = 1ms, .first_frame = 1ms});
    static_cast<void>(next_record(session));
    EXPECT_TRUE(std::holds_alternative<NoFrame>(session.next(30ms)));
}

TEST(CaptureSessionTest, WithoutReconnectionALostCameraEndsTheSession) {
    CaptureSession session(plays({{is_lost("unplugged")}}), {.reconnect = false});
    EXPECT_EQ(wait_for<DeviceLost>(session).reason, "unplugged");
    EXPECT_EQ(session.totals().outages, 1U);
}

TEST(CaptureSessionTest, TheEndOfAReplayIsNoOutageAndOpensNothingAnew) {
    const ScriptedStep end{[] { return Arrival(DeviceLost{"at its end", true}); }, {}};
    CaptureSession session(plays({{end}}), {});
    EXPECT_TRUE(wait_for<DeviceLost>(session).at_end);
    EXPECT_EQ(session.totals().outages, 0U);
}

TEST(CaptureSessionTest, FramesThatAReplayLosesAtItsEndAreCounted) {
    std::deque<ScriptedStep> script = frames({1, 2});
    script.push_back({[] { return Arrival(DeviceLost{"at its end", true}); }, {.underruns = 3}});
    CaptureSession session(plays({script}), {});
    for (int frame = 0; frame < 2; ++frame) static_cast<void>(next_record(session));
    EXPECT_TRUE(wait_for<DeviceLost>(session).at_end);
    EXPECT_EQ(session.totals().lost[static_cast<std::size_t>(GapCause::kHostUnderrun)], 3U);
}

TEST(CaptureSessionTest, ACameraThatCannotBeOpenedYetIsTriedAgain) {
    std::atomic<int> tries = 0;
    const auto first = plays({{is_lost("unplugged")}});
    const auto later = plays({frames({1})});
    CaptureSession session(
        [&]() -> std::unique_ptr<Camera> {
            const int now = tries++;
            if (now == 0) return first();
            if (now < 3) throw DeviceError("camera", "is not there");
            return later();
        },
        {});
    static_cast<void>(wait_for<Outage>(session));
    static_cast<void>(wait_for<Recovery>(session));
    EXPECT_EQ(tries, 4);
    EXPECT_EQ(next_record(session).epoch, 1U);
}

TEST(CaptureSessionTest, ClosingADeadCameraHoldsNothingUp) {
    // Its end comes after the new camera's first frame has.
    std::promise<void> got_frame;
    const auto wait_for_frame = got_frame.get_future().share();
    std::atomic<int> opened = 0;
    {
        CaptureSession session(
            [&]() -> std::unique_ptr<Camera> {
                if (opened++ > 0) return std::make_unique<ScriptedCamera>(frames({1}));
                auto dead = std::make_unique<ScriptedCamera>(
                    std::deque<ScriptedStep>{is_lost("unplugged")});
                dead->on_close = [&] { wait_for_frame.wait_for(kLong); };
                return dead;
            },
            {});
        static_cast<void>(wait_for<Outage>(session));
        static_cast<void>(wait_for<Recovery>(session));
        static_cast<void>(next_record(session));
        got_frame.set_value();
    }
    EXPECT_EQ(opened, 2);
}

TEST(CaptureSessionTest, ASessionCanEndDuringAnOutage) {
    std::atomic<int> opened = 0;
    CaptureSession session(
        [&]() -> std::unique_ptr<Camera> {
            if (opened++ > 0) throw DeviceError("camera", "is not there");
            return std::make_unique<ScriptedCamera>(std::deque<ScriptedStep>{is_lost("unplugged")});
        },
        {});
    static_cast<void>(wait_for<Outage>(session));
    EXPECT_TRUE(std::holds_alternative<NoFrame>(session.next(1ms)));
}

}  // namespace
}  // namespace stipple
