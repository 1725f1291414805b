// Runs in the virtual machine of tests/vm/boot.py: USB3 Vision through Aravis, libusb and the
// kernel's USB core, with usb3_vision_gadget at the other end of a dummy_hcd port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "capture/camera_search.h"
#include "capture/capture_session.h"
#include "capture/doctor/doctor_findings.h"
#include "capture/open_camera.h"
#include "capture/recording/recording_reader.h"
#include "core/error.h"
#include "tests/capture/aravis/fake_camera_process.h"
#include "tests/capture/fake_frame.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

constexpr const char* kSerial = "GADGET1";
constexpr const char* kAddress = "usb:GADGET1";

CaptureSession session_of(const CameraSettings& settings = {}, int frames = 8) {
    SessionOptions options;
    options.stall = 5000ms;  // the machine is emulated
    options.first_frame = 20000ms;
    return CaptureSession([=] { return open_camera(kAddress, settings, {.frames = frames}); },
                          options);
}

std::vector<std::uint8_t> sent(const FrameRecord& record) {
    std::vector<std::uint8_t> bytes(record.layout.payload_bytes());
    fill_fake_frame(bytes, record.wire_id);
    return bytes;
}

/// Of a frame that was cut, the packet that came next is no part of the image.
void expect_cut(const CapturedFrame& frame, std::size_t left) {
    auto expected = sent(frame.record);
    ASSERT_GT(expected.size(), left);
    std::fill(expected.begin() + static_cast<std::ptrdiff_t>(left), expected.end(),
              std::uint8_t{0});
    EXPECT_EQ(frame.payload, expected);
    ASSERT_EQ(frame.holes.size(), 1);
    EXPECT_EQ(frame.holes[0].first, left);
    EXPECT_EQ(frame.holes[0].second, expected.size());
    EXPECT_EQ(frame.record.bytes_received, left);
}

class Usb3VisionTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        camera_ = std::make_unique<FakeCameraProcess>(std::vector<std::string>{kSerial},
                                                      "usb3_vision_gadget");
        for (int i = 0; i < 600 && listed() == nullptr; ++i) std::this_thread::sleep_for(100ms);
        ASSERT_NE(listed(), nullptr) << "the port has no camera";
    }
    static void TearDownTestSuite() { camera_.reset(); }

    static const CameraListing* listed() {
        static CameraSearch search;
        search = list_cameras();
        const auto found = std::find_if(search.cameras.begin(), search.cameras.end(),
                                        [](const auto& one) { return one.address == kAddress; });
        return found == search.cameras.end() ? nullptr : &*found;
    }

    /// The next event of that kind; frames may come before it.
    template <typename Event>
    static Event wait_for(CaptureSession& session) {
        for (int i = 0; i < 600; ++i) {
            auto event = session.next(100ms);
            if (auto* wanted = std::get_if<Event>(&event)) return std::move(*wanted);
            if (const auto* lost = std::get_if<DeviceLost>(&event)) ADD_FAILURE() << lost->reason;
        }
        ADD_FAILURE() << "nothing came";
        return {};
    }

    static CapturedFrame next_frame(CaptureSession& session) {
        return wait_for<CapturedFrame>(session);
    }

    static CapturedFrame next_incomplete(CaptureSession& session) {
        CapturedFrame frame;
        for (int i = 0; i < 50; ++i) {
            frame = next_frame(session);
            if (frame.record.status != FrameStatus::kComplete) return frame;
        }
        ADD_FAILURE() << "all complete";
        return frame;
    }

    inline static std::unique_ptr<FakeCameraProcess> camera_;
};

TEST_F(Usb3VisionTest, ACameraIsListedByItsSerialNumber) {
    const CameraListing* found = listed();
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->transport, "USB3 Vision");
    EXPECT_EQ(found->vendor, "Stipple");
    EXPECT_EQ(found->model, "Gadget");
    EXPECT_EQ(found->serial, kSerial);
}

TEST_F(Usb3VisionTest, TheDoctorFindsItAtAFastPort) {
    const auto findings = usb_findings();
    const auto found = std::find_if(findings.begin(), findings.end(),
                                    [](const auto& one) { return one.subject == kAddress; });
    ASSERT_NE(found, findings.end());
    EXPECT_EQ(found->level, DoctorFinding::Level::kGood);
    EXPECT_EQ(found->fact, "Stipple Gadget at 5000 Mbit/s");
}

TEST_F(Usb3VisionTest, FramesInEveryFormatAreBitExact) {
    for (const char* name : {"Mono8", "Mono12p", "Mono16", "RGB8"}) {
        SCOPED_TRACE(name);
        CaptureSession session = session_of({{"PixelFormat", name}});
        for (std::uint64_t i = 0; i < 10; ++i) {
            const CapturedFrame frame = next_frame(session);
            ASSERT_EQ(frame.record.status, FrameStatus::kComplete);
            ASSERT_EQ(frame.record.layout.format->name, name);
            ASSERT_EQ(frame.record.wire_id, i);
            ASSERT_EQ(frame.record.device_ns, fake_stamp_ns(i));
            ASSERT_EQ(frame.payload, sent(frame.record)) << "frame " << i;
        }
        EXPECT_EQ(session.description().transport, "USB3 Vision");
    }
}

TEST_F(Usb3VisionTest, IdsThatTheCameraLeavesOutAreADeviceGap) {
    CaptureSession session = session_of();
    next_frame(session);
    camera_->command("skip 5");
    FrameRecord record;
    for (int i = 0; i < 50 && record.lost_before == 0; ++i) record = next_frame(session).record;
    EXPECT_EQ(record.lost_before, 5);
    EXPECT_EQ(record.cause, GapCause::kDevice);
}

TEST_F(Usb3VisionTest, OfACutFrameWhatDidNotComeIsZero) {
    CaptureSession session = session_of({{"PixelFormat", "Mono8"}});
    next_frame(session);
    camera_->command("cut 5000");
    const CapturedFrame frame = next_incomplete(session);
    EXPECT_EQ(frame.record.status, FrameStatus::kSizeMismatch);
    EXPECT_EQ(frame.record.lost_before, 0);
    expect_cut(frame, 5000);
}

TEST_F(Usb3VisionTest, WhereATrailerIsLostTheNextFrameIsUnharmed) {
    CaptureSession session = session_of({{"PixelFormat", "Mono8"}});
    next_frame(session);
    for (int lost = 0; lost < 5; ++lost) {
        camera_->command("cut 5000");
        camera_->command("lose_trailer");
        const CapturedFrame frame = next_incomplete(session);
        expect_cut(frame, 5000);
        const CapturedFrame next = next_frame(session);
        EXPECT_EQ(next.record.wire_id, frame.record.wire_id + 1);
        EXPECT_EQ(next.record.status, FrameStatus::kComplete);
        EXPECT_EQ(next.payload, sent(next.record));
    }
}

TEST_F(Usb3VisionTest, AFrameOfWhichOnlyTheTrailerIsLostIsComplete) {
    CaptureSession session = session_of({{"PixelFormat", "Mono8"}});
    next_frame(session);
    camera_->command("lose_trailer");
    for (int i = 0; i < 20; ++i) {
        const CapturedFrame frame = next_frame(session);
        ASSERT_EQ(frame.record.status, FrameStatus::kComplete);
        ASSERT_EQ(frame.record.lost_before, 0);
        ASSERT_EQ(frame.payload, sent(frame.record));
    }
}

TEST_F(Usb3VisionTest, FramesForWhichNoBufferWasFreeAreHostUnderruns) {
    CaptureSession session = session_of({{"AcquisitionFrameRate", "50"}}, 2);
    next_frame(session);
    for (int i = 0; i < 600 && session.transport().underruns == 0; ++i)
        std::this_thread::sleep_for(100ms);
    FrameRecord record;
    for (int i = 0; i < 50 && record.lost_before == 0; ++i) record = next_frame(session).record;
    EXPECT_GT(record.lost_before, 0);
    EXPECT_EQ(record.cause, GapCause::kHostUnderrun);
}

TEST_F(Usb3VisionTest, FramesThatGrowGetLargerBuffers) {
    CaptureSession session = session_of();
    const FrameRecord before = next_frame(session).record;
    camera_->command("width 320");
    CapturedFrame frame;
    for (int i = 0; i < 100; ++i) {
        frame = next_frame(session);
        if (frame.record.layout.width == 320 && frame.record.status == FrameStatus::kComplete)
            break;
    }
    EXPECT_EQ(frame.record.layout.width, 320);
    EXPECT_GT(frame.record.epoch, before.epoch);
    EXPECT_EQ(frame.payload, sent(frame.record));
    camera_->command("width 160");
}

TEST_F(Usb3VisionTest, AnUnpluggedCameraComesBackAsANewEpochWithItsSettings) {
    CaptureSession session = session_of({{"PixelFormat", "Mono12p"}});
    const FrameRecord before = next_frame(session).record;
    camera_->command("unplug");
    wait_for<Outage>(session);
    camera_->command("plug");
    wait_for<Recovery>(session);
    const CapturedFrame frame = next_frame(session);
    EXPECT_EQ(frame.record.epoch, before.epoch + 1);
    EXPECT_EQ(frame.record.layout, before.layout);
    EXPECT_GT(frame.record.id, before.id);
    EXPECT_EQ(frame.payload, sent(frame.record));
}

TEST_F(Usb3VisionTest, ASecondProgramIsToldThatTheCameraIsTaken) {
    CaptureSession session = session_of();
    next_frame(session);
    try {
        static_cast<void>(open_camera(kAddress, {}, {}));
        FAIL() << "opened twice";
    } catch (const DeviceError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("another program has the camera"));
    }
}

TEST_F(Usb3VisionTest, TheProgramRecordsItBitExactly) {
    const auto file = std::filesystem::temp_directory_path() / "usb.strec";
    const std::string command = built_program("stipple").string() + " capture record " + kAddress +
                                " -o " + file.string() + " --frames 20 --stall 5000 --force";
    ASSERT_EQ(std::system(command.c_str()), 0);
    RecordingReader reader(file);
    int frames = 0;
    for (CapturedFrame frame; reader.next(frame); ++frames) {
        ASSERT_EQ(frame.record.status, FrameStatus::kComplete);
        ASSERT_EQ(frame.payload, sent(frame.record));
    }
    EXPECT_EQ(frames, 20);
    EXPECT_EQ(reader.session().camera.transport, "USB3 Vision");
}

}  // namespace
}  // namespace stipple
