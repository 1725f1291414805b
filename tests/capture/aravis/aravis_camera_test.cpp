#include "capture/aravis/aravis_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <thread>
#include <variant>
#include <vector>

#include "capture/aravis/aravis_device.h"
#include "capture/capture_session.h"
#include "capture/frame_record.h"
#include "capture/open_camera.h"
#include "core/error.h"
#include "tests/capture/aravis/fake_camera_process.h"
#include "tests/capture/aravis/genicam_file.h"
#include "tests/capture/fake_frame.h"
#include "tests/capture/pooled_frames.h"
#include "tests/support/private_network.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

// Registers of Aravis' fake camera (arvfakecamera.h).
constexpr unsigned kWidthRegister = 0x100;
constexpr unsigned kHeightRegister = 0x104;

constexpr auto kLong = 60s;  // a bound that only a broken capture reaches

/// Against Aravis' own fake camera, which shares no code with ours, over UDP.
class AravisCameraTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string why = enter_private_network(); !why.empty()) GTEST_SKIP() << why;
    }

    static CaptureSession::Opener opener(const CameraSettings& settings = {},
                                         CameraBuffers buffers = {}) {
        return [=] { return open_camera("gige:127.0.0.1", settings, buffers); };
    }

    /// The next event of that kind; frames may come before it.
    template <typename Event>
    static Event wait_for(CaptureSession& session) {
        const auto end = std::chrono::steady_clock::now() + kLong;
        while (std::chrono::steady_clock::now() < end) {
            auto event = session.next(100ms);
            if (auto* wanted = std::get_if<Event>(&event)) return std::move(*wanted);
        }
        ADD_FAILURE() << "nothing came";
        return {};
    }

    static CapturedFrame next_frame(CaptureSession& session) {
        return wait_for<CapturedFrame>(session);
    }

    /// The bytes that the fake sent with that id.
    static std::vector<std::uint8_t> sent(const FrameRecord& record) {
        std::vector<std::uint8_t> bytes(record.layout.payload_bytes());
        fill_fake_frame(bytes, record.wire_id);
        return bytes;
    }
};

TEST_F(AravisCameraTest, FramesInEveryFormatAreBitExact) {
    for (const char* name : {"Mono8", "Mono16", "Mono10p", "Mono12p", "BayerRG12p", "RGB8"}) {
        SCOPED_TRACE(name);
        const PixelFormat* format = pixel_format_named(name);
        ASSERT_NE(format, nullptr);
        const FakeCameraProcess camera(
            {"width=320", "height=240", "format=" + std::to_string(format->pfnc)});
        CaptureSession session(opener(), {.stall = 0ms});
        for (int i = 0; i < 20; ++i) {
            const CapturedFrame frame = next_frame(session);
            ASSERT_EQ(frame.record.status, FrameStatus::kComplete);
            ASSERT_EQ(frame.record.layout.format, format);
            ASSERT_EQ(frame.record.bytes_received, frame.payload.size());
            ASSERT_EQ(frame.payload, sent(frame.record)) << "frame " << i;
        }
    }
}

TEST_F(AravisCameraTest, FramesHaveTheMemoryOfThePool) {
    const FakeCameraProcess camera;
    expect_frames_from_pool(*opener()(), 20);
}

TEST_F(AravisCameraTest, StampsAreTheCamerasOwnAndTheHostsBothClocks) {
    const FakeCameraProcess camera;
    CaptureSession session(opener(), {.stall = 0ms});
    const FrameRecord first = next_frame(session).record;
    const FrameRecord second = next_frame(session).record;
    EXPECT_EQ(first.stamp_source, StampSource::kDeviceClock);
    const auto steps = static_cast<std::int64_t>(second.id - first.id);
    EXPECT_EQ(second.device_ns - first.device_ns, steps * 5'000'000);
    // Aravis stamps in microseconds: where the host was late for both, they arrive together.
    EXPECT_GE(second.host_monotonic_ns, first.host_monotonic_ns);
    EXPECT_GT(first.host_realtime_ns, std::int64_t{1'600'000'000} * 1'000'000'000);
    EXPECT_EQ(first.exposure_us, 10000.0);  // the setting of the fake
}

/// Stamps of a frame that waits are those of its arrival: on both clocks the same time ago.
TEST_F(AravisCameraTest, StampsOfAFrameThatWaitsAreThoseOfItsArrival) {
    constexpr std::int64_t kPeriodNs = 5'000'000, kWaitNs = 400'000'000;
    const FakeCameraProcess camera;
    const auto opened = opener({}, {.frames = 64})();
    opened->start();
    std::this_thread::sleep_for(std::chrono::nanoseconds(kWaitNs));
    const std::int64_t clocks_ns = realtime_ns() - monotonic_ns();
    std::vector<FrameRecord> records;
    while (records.size() < 10) {
        Arrival arrival = opened->wait(1s);
        ASSERT_TRUE(std::holds_alternative<CapturedFrame>(arrival));
        records.push_back(std::get<CapturedFrame>(arrival).record);
    }
    EXPECT_GT(monotonic_ns() - records[0].host_monotonic_ns, kWaitNs / 2);
    EXPECT_GT(records[9].host_monotonic_ns - records[0].host_monotonic_ns, 9 * kPeriodNs / 2);
    for (const FrameRecord& record : records)
        EXPECT_NEAR(static_cast<double>(record.host_realtime_ns - record.host_monotonic_ns),
                    static_cast<double>(clocks_ns), kPeriodNs);
    opened->stop();
}

TEST_F(AravisCameraTest, IdsThatWrapLeaveNoGap) {
    const FakeCameraProcess camera({"first_id=65530"});
    CaptureSession session(opener(), {.stall = 0ms});
    FrameRecord record = next_frame(session).record;
    const std::uint64_t first_wire_id = record.wire_id;
    for (int i = 0; i < 20; ++i) {
        const FrameRecord next = next_frame(session).record;
        ASSERT_EQ(next.id, record.id + 1 + next.lost_before);
        record = next;
    }
    EXPECT_EQ(record.epoch, 0U);
    EXPECT_EQ((first_wire_id - 1 + record.id) % 65535 + 1, record.wire_id);
}

TEST_F(AravisCameraTest, IdsThatTheCameraLeavesOutAreItsOwnGap) {
    const FakeCameraProcess camera({"gap_at=10", "gap=7"});
    CaptureSession session(opener(), {.stall = 0ms});
    FrameRecord record = next_frame(session).record;
    while (record.wire_id <= 10) record = next_frame(session).record;
    EXPECT_GE(record.lost_before, 7U);
    EXPECT_EQ(record.cause, GapCause::kDevice);
}

TEST_F(AravisCameraTest, WhatIsMissingOfAFrameIsZeroAndNeverOfAnOlderFrame) {
    // The fake does not resend what it loses.
    const FakeCameraProcess camera({"width=320", "height=240", "lost_permille=30"});
    CaptureSession session(opener({{"GevSCPSPacketSize", "1400"}}, {.frames = 4}), {.stall = 0ms});
    int incomplete = 0;
    for (int i = 0; incomplete < 5 && i < 500; ++i) {
        const CapturedFrame frame = next_frame(session);
        // Where the leader was lost, the id is a guess, and so would be the frame that was sent.
        if (frame.record.stamp_source == StampSource::kNone) continue;
        auto expected = sent(frame.record);
        std::size_t missing = 0;
        for (const auto& [begin, end] : frame.holes) {
            missing += end - begin;
            std::fill(expected.begin() + static_cast<std::ptrdiff_t>(begin),
                      expected.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
        }
        ASSERT_EQ(frame.payload, expected);
        ASSERT_EQ(frame.record.bytes_received, frame.payload.size() - missing);
        ASSERT_EQ(frame.record.status == FrameStatus::kComplete, missing == 0);
        if (missing > 0) ++incomplete;
    }
    EXPECT_EQ(incomplete, 5);
}

TEST_F(AravisCameraTest, FramesThatOutgrowTheirBuffersAreCutMarkedAndThenWhole) {
    FakeCameraProcess camera({"width=320", "height=240"});
    // Aravis calls a frame that was cut a success, of the size that the camera says.
    const auto open = [&] {
        auto opened = open_camera("gige:127.0.0.1", {}, {.frames = 4});
        camera.write_register(kWidthRegister, 640);
        camera.write_register(kHeightRegister, 480);
        return opened;
    };
    CaptureSession session(open, {.incomplete = IncompletePolicy::kKeep, .stall = 0ms});
    CapturedFrame frame = next_frame(session);
    EXPECT_EQ(frame.record.status, FrameStatus::kSizeMismatch);
    EXPECT_EQ(frame.record.layout.width, 640);
    EXPECT_EQ(frame.payload.size(), 640U * 480U);
    auto expected = sent(frame.record);
    std::fill(expected.begin() + 320 * 240, expected.end(), std::uint8_t{0});
    EXPECT_EQ(frame.payload, expected);
    for (int i = 0; i < 200 && frame.record.status != FrameStatus::kComplete; ++i)
        frame = next_frame(session);
    EXPECT_EQ(frame.record.status, FrameStatus::kComplete);
    EXPECT_EQ(frame.payload, sent(frame.record));
}

TEST_F(AravisCameraTest, FramesThatShrinkBeginAnEpochAndHoldNothingOfTheOlderOnes) {
    FakeCameraProcess camera({"width=320", "height=240"});
    CaptureSession session(opener(), {.stall = 0ms});
    EXPECT_EQ(next_frame(session).record.epoch, 0U);
    camera.write_register(kWidthRegister, 160);
    CapturedFrame frame = next_frame(session);
    for (int i = 0; i < 200 && frame.record.layout.width != 160; ++i) frame = next_frame(session);
    EXPECT_EQ(frame.record.epoch, 1U);
    EXPECT_EQ(frame.record.status, FrameStatus::kComplete);
    EXPECT_EQ(frame.payload, sent(frame.record));
}

TEST_F(AravisCameraTest, ACameraThatWasKilledComesBackWithItsSettings) {
    FakeCameraProcess camera;
    CaptureSession session(opener({{"Width", "128"}, {"AcquisitionFrameRate", "100"}}), {});
    const FrameRecord before = next_frame(session).record;
    camera.kill();
    EXPECT_FALSE(wait_for<Outage>(session).reason.empty());
    camera.start();
    EXPECT_GT(wait_for<Recovery>(session).gone_s, 0);
    const CapturedFrame frame = next_frame(session);
    EXPECT_GT(frame.record.epoch, before.epoch);  // on a busy machine it may be taken up twice
    EXPECT_EQ(frame.record.layout.width, 128);    // 64 after it was switched on
    EXPECT_EQ(frame.record.cause, GapCause::kReconnect);
}

TEST_F(AravisCameraTest, ACameraThatHangsIsNoticedAndTakenUpAgain) {
    const FakeCameraProcess camera;
    CaptureSession session(opener(), {});
    static_cast<void>(next_frame(session));
    camera.freeze();
    static_cast<void>(wait_for<Outage>(session));
    camera.thaw();
    static_cast<void>(wait_for<Recovery>(session));
    EXPECT_GE(next_frame(session).record.epoch, 1U);
}

TEST_F(AravisCameraTest, ACameraThatAnotherProgramControlsIsRefused) {
    const FakeCameraProcess camera;
    const auto first = open_camera("gige:127.0.0.1", {}, {});
    try {
        static_cast<void>(open_camera("gige:127.0.0.1", {}, {}));
        ADD_FAILURE() << "two controllers";
    } catch (const DeviceError& e) {
        EXPECT_NE(std::string(e.what()).find("another program"), std::string::npos) << e.what();
    }
}

TEST_F(AravisCameraTest, AConsumerThatIsTooSlowLosesFramesToItsOwnBuffers) {
    const FakeCameraProcess camera({"width=640", "height=480"});
    auto opened = open_camera("gige:127.0.0.1", {}, {.frames = 2});
    const Camera& watched = *opened;
    CaptureSession session([&] { return std::move(opened); }, {.stall = 0ms, .reconnect = false});
    static_cast<void>(next_frame(session));
    const auto end = std::chrono::steady_clock::now() + kLong;
    while (watched.counts().underruns == 0 && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(1ms);
    for (int i = 0; i < 50; ++i) {
        const CapturedFrame frame = next_frame(session);
        if (frame.record.status == FrameStatus::kComplete) {
            ASSERT_EQ(frame.payload, sent(frame.record));
        }
        // A busy machine loses frames in other ways, too.
        if (frame.record.cause == GapCause::kHostUnderrun) {
            EXPECT_GT(frame.record.lost_before, 0U);
            return;
        }
    }
    ADD_FAILURE() << "no gap by underruns";
}

TEST_F(AravisCameraTest, AReceiveBufferThatIsTooSmallIsWarnedOfByTheNameOfItsLimit) {
    ASSERT_TRUE(drop_capabilities());
    const FakeCameraProcess camera;
    auto opened = open_camera("gige:127.0.0.1", {}, {.socket_frames = 1'000'000});
    const CameraDescription description = opened->description();
    ASSERT_EQ(description.warnings.size(), 1U);
    EXPECT_NE(description.warnings[0].text().find("net.core.rmem_max="), std::string::npos);
    CaptureSession session([&] { return std::move(opened); }, {.stall = 0ms, .reconnect = false});
    const CapturedFrame frame = next_frame(session);
    if (frame.record.status == FrameStatus::kComplete) {
        EXPECT_EQ(frame.payload, sent(frame.record));
    }
}

TEST_F(AravisCameraTest, AReceiveBufferThatIsLargeEnoughIsNotWarnedOf) {
    ASSERT_TRUE(drop_capabilities());
    const FakeCameraProcess camera;
    EXPECT_TRUE(open_camera("gige:127.0.0.1", {}, {})->description().warnings.empty());
}

TEST_F(AravisCameraTest, TheDescriptionSaysWhatTheCameraIsAndWasSetTo) {
    const FakeCameraProcess camera;
    const auto opened = open_camera("gige:127.0.0.1", {{"AcquisitionFrameRate", "50"}}, {});
    const CameraDescription description = opened->description();
    EXPECT_EQ(description.transport, "GigE Vision");
    EXPECT_EQ(description.vendor, "Aravis");
    EXPECT_EQ(description.model, "Fake");
    EXPECT_EQ(description.genicam_xml_hash.size(), 16U);
    EXPECT_EQ(description.features.at("Width"), "64");
    EXPECT_EQ(description.features.at("AcquisitionFrameRate"), "50");
    EXPECT_EQ(description.transport_facts.at("packet_resend"), "always");
    EXPECT_EQ(description.transport_facts.at("interface"), "lo");
}

TEST_F(AravisCameraTest, SettingsThatCannotBeAreRefusedWithTheirPlaceAndChoices) {
    const FakeCameraProcess camera;
    struct Case {
        std::pair<std::string, std::string> setting;
        std::string expected;
    };
    for (const Case& one :
         {Case{{"Wdith", "64"}, "Wdith: the camera has no such feature"},
          Case{{"Width", "many"}, "needs an integer"}, Case{{"PixelFormat", "Mono99"}, "Mono16"},
          Case{{"GainRaw", "11"}, "allowed maximum '10'"},
          Case{{"AcquisitionFrameRate", "fast"}, "needs a number"}}) {
        try {
            static_cast<void>(open_camera("gige:127.0.0.1", {one.setting}, {}));
            ADD_FAILURE() << one.setting.first << " was taken";
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find(one.expected), std::string::npos) << e.what();
        }
    }
}

// PFNC: images of "p" formats are one string of bits, rows have no padding.
TEST_F(AravisCameraTest, RowsThatEndWithinAByteAreRefused) {
    for (const char* name : {"Mono10p", "Mono12p"}) {
        const FakeCameraProcess camera(
            {"width=63", "height=48", "format=" + std::to_string(pixel_format_named(name)->pfnc)});
        try {
            static_cast<void>(open_camera("gige:127.0.0.1", {}, {}));
            ADD_FAILURE() << name << " was taken";
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("Width: rows of 63 pixels"), std::string::npos)
                << e.what();
        }
    }
}

TEST_F(AravisCameraTest, BuffersThatTheMachineHasNoRoomForAreRefused) {
    FakeCameraProcess camera;
    camera.write_register(kWidthRegister, 32768);
    camera.write_register(kHeightRegister, 32768);
    try {
        static_cast<void>(open_camera("gige:127.0.0.1", {}, {.frames = 1024}));  // 1 TiB
        ADD_FAILURE() << "were taken";
    } catch (const InputError& e) {
        for (const char* part : {"gige:127.0.0.1: PayloadSize: 1024 buffers of 1073741824 bytes",
                                 "max_memory", "buffers"})
            EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
}

TEST_F(AravisCameraTest, FeaturesAreListedOnceHoweverTheirCategoriesNameEachOther) {
    const auto category = [](const std::string& name, const std::string& feature) {
        const std::string link = "<pFeature>" + feature + "</pFeature>";
        return "<Category Name=\"" + name + "\">" + link + link + "</Category>\n";
    };
    std::string nodes =
        "<Category Name=\"Root\"><pFeature>Root</pFeature><pFeature>C0</pFeature></Category>\n";
    for (int i = 0; i < 40; ++i)  // 2^40 ways from the first to the last
        nodes += category("C" + std::to_string(i), "C" + std::to_string(i + 1));
    nodes += category("C40", "Width") + "<Integer Name=\"Width\"><Value>64</Value></Integer>\n";
    const GenicamFile file(nodes);
    const FakeCameraProcess camera({"genicam=" + file.path().string()});
    const AravisDevice device("gige:127.0.0.1");
    EXPECT_EQ(device.features(), (std::map<std::string, std::string>{{"Width", "64"}}));
}

TEST_F(AravisCameraTest, WhereNoCameraAnswersTheMessageSaysWhatToCheck) {
    EXPECT_THROW(static_cast<void>(open_camera("gige:127.0.0.1", {}, {})), DeviceError);
    EXPECT_THROW(static_cast<void>(open_camera("gige:camera", {}, {})), InputError);
    EXPECT_THROW(static_cast<void>(open_camera("firewire:1", {}, {})), InputError);
    EXPECT_THROW(static_cast<void>(open_camera("gige:127.0.0.1", {}, {.frames = 1})), InputError);
}

}  // namespace
}  // namespace stipple
