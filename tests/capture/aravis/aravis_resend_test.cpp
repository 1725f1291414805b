#include <gtest/gtest.h>

#include <numeric>

#include "capture/capture_session.h"
#include "capture/open_camera.h"
#include "capture/serve/gige_registers.h"
#include "capture/serve/gvsp_codec.h"
#include "tests/capture/serve/gige_client.h"
#include "tests/capture/serve/gige_serving.h"
#include "tests/support/private_network.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 60s;  // a bound that only a broken capture reaches
constexpr std::uint64_t kFrames = 100'000;

/// Against our own server, which can do what Aravis' fake camera cannot: resend, reorder, chunks.
class AravisResendTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string why = enter_private_network(); !why.empty()) GTEST_SKIP() << why;
    }

    /// Frames of a camera with these faults, in order of arrival, and what they cost.
    struct Outcome {
        std::vector<CapturedFrame> frames;
        SessionTotals totals;
        TransportCounts transport;
    };
    static Outcome capture(NoiseFrames& source, const GigeServerOptions& options, int frames,
                           IncompletePolicy policy = IncompletePolicy::kMask) {
        const GigeServing server(source, options);
        EXPECT_EQ(server.failure(), "");
        Outcome outcome;
        CaptureSession session(
            [&] {
                return open_camera("gige:" + ipv4_text(server.address()),
                                   {{"GevSCPSPacketSize", "1500"}}, {});
            },
            {.incomplete = policy, .stall = 0ms});
        const auto end = std::chrono::steady_clock::now() + kLong;
        while (static_cast<int>(outcome.frames.size()) < frames &&
               std::chrono::steady_clock::now() < end) {
            auto event = session.next(100ms);
            if (auto* frame = std::get_if<CapturedFrame>(&event))
                outcome.frames.push_back(std::move(*frame));
        }
        EXPECT_EQ(static_cast<int>(outcome.frames.size()), frames);
        outcome.totals = session.totals();
        outcome.transport = session.transport();
        return outcome;
    }

    /// The frame as it was sent: its wire id says which.
    static std::vector<std::uint8_t> sent(const NoiseFrames& source, const FrameRecord& record) {
        return source.bytes(record.wire_id - 1, *record.layout.format);
    }
};

TEST_F(AravisResendTest, PacketsThatWereDroppedOnceAreSentAgain) {
    NoiseFrames source(320, 240, {"Mono16"}, kFrames);
    const Outcome outcome = capture(source, {.faults = {.drop = 0.01}}, 60);
    EXPECT_GT(outcome.transport.packets_resent, 0U);
    int whole = 0;
    for (const CapturedFrame& frame : outcome.frames) {
        if (frame.record.status != FrameStatus::kComplete) continue;
        ++whole;
        ASSERT_EQ(frame.payload, sent(source, frame.record));
    }
    // A busy machine may answer a request too late.
    EXPECT_GE(whole, 40);
}

TEST_F(AravisResendTest, FromACameraThatCannotResendWhatWasDroppedStaysMissing) {
    NoiseFrames source(320, 240, {"Mono8"}, kFrames);
    const Outcome outcome = capture(source, {.can_resend = false, .faults = {.drop = 0.01}}, 40);
    EXPECT_EQ(outcome.transport.packets_resent, 0U);
    EXPECT_GT(outcome.totals.incomplete, 0U);
}

TEST_F(AravisResendTest, ColourFramesAreBitExact) {
    NoiseFrames source(160, 120, {"RGB8"}, kFrames);
    const Outcome outcome = capture(source, {}, 30);
    int whole = 0;
    for (const CapturedFrame& frame : outcome.frames) {
        if (frame.record.status != FrameStatus::kComplete) continue;
        ++whole;
        ASSERT_EQ(frame.record.layout.format->name, "RGB8");
        ASSERT_EQ(frame.payload, sent(source, frame.record));
    }
    EXPECT_GE(whole, 20);  // a busy machine may lose some
}

TEST_F(AravisResendTest, PacketsThatAreNeverSentLeaveZerosAndTheirPlaces) {
    NoiseFrames source(320, 240, {"Mono8"}, kFrames);
    const Outcome outcome = capture(source, {.faults = {.lose = 0.01}}, 40);
    int incomplete = 0;
    for (const CapturedFrame& frame : outcome.frames) {
        if (frame.record.stamp_source == StampSource::kNone) continue;  // without leader: id unsure
        auto expected = sent(source, frame.record);
        for (const auto& [begin, end] : frame.holes)
            std::fill(expected.begin() + static_cast<std::ptrdiff_t>(begin),
                      expected.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
        ASSERT_EQ(frame.payload, expected);
        ASSERT_EQ(frame.holes.empty(), frame.record.status == FrameStatus::kComplete);
        if (!frame.holes.empty()) ++incomplete;
    }
    EXPECT_GT(incomplete, 0);
    EXPECT_GE(outcome.totals.incomplete, static_cast<std::uint64_t>(incomplete));
}

TEST_F(AravisResendTest, PacketsOutOfOrderAndTwiceMakeTheSameFrames) {
    NoiseFrames source(320, 240, {"Mono8"}, kFrames);
    const Outcome outcome = capture(source, {.faults = {.duplicate = 0.05, .reorder = true}}, 40);
    for (const CapturedFrame& frame : outcome.frames)
        if (frame.record.status == FrameStatus::kComplete) {
            ASSERT_EQ(frame.payload, sent(source, frame.record));
        }
}

TEST_F(AravisResendTest, EveryIdIsAccountedForWhateverIsLost) {
    NoiseFrames source(320, 240, {"Mono8"}, kFrames);
    const GvspFaults faults{.lose = 0.02, .gap_at = 20, .gap_frames = 5};
    const Outcome outcome = capture(source, {.faults = faults}, 40, IncompletePolicy::kDrop);
    std::uint64_t missing = 0;
    for (std::size_t i = 1; i < outcome.frames.size(); ++i) {
        const FrameRecord& before = outcome.frames[i - 1].record;
        const FrameRecord& record = outcome.frames[i].record;
        ASSERT_EQ(record.id, before.id + 1 + record.lost_before);
        ASSERT_EQ(record.id - before.id, record.wire_id - before.wire_id);
        missing += record.lost_before;
    }
    missing += outcome.frames.front().record.lost_before;
    const auto& lost = outcome.totals.lost;
    const std::uint64_t counted = std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
    EXPECT_EQ(missing, counted);
    EXPECT_GE(missing, 5U);
}

/// A camera that sends nothing itself; the test does, from its address.
class ForgedStream {
  public:
    explicit ForgedStream(std::uint32_t address) : forger_(address, address) {
        camera_ = open_camera("gige:" + ipv4_text(address), {}, {.frames = 4});
        camera_->start();
    }
    /// A block of 64 x 48 pixels, whose leader says `image` and `payload_type`.
    void send(GvspImage image, std::uint8_t payload_type, std::uint16_t id, UdpEndpoint from = {}) {
        GvspBlock block;
        block.id = id;
        image.pixel_format = pixel_format_named("Mono8")->pfnc;
        block.image = image;
        block.payload.resize(64 * 48, 7);
        block.piece_bytes = block.payload.size();
        const UdpEndpoint to{0x7F000001,
                             static_cast<std::uint16_t>(*forger_.read(gige::kStreamPort))};
        for (std::uint32_t i = 0; i < block.packets(); ++i) {
            GvspPacket packet = gvsp_packet(block, i);
            if (i == 0) packet.head[11] = payload_type;
            const DatagramParts parts{std::span(packet.head).first(packet.head_bytes), packet.data};
            if (from.is_set())
                UdpSocket(from).send(to, std::span(&parts, 1));
            else
                forger_.data().send(to, std::span(&parts, 1));
        }
    }
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout = kLong) {
        return camera_->wait(timeout);
    }
    [[nodiscard]] int width() const { return camera_->layout().width; }

  private:
    GigeClient forger_;
    std::unique_ptr<Camera> camera_;
};

TEST_F(AravisResendTest, ALeaderOfAnotherSizeDoesNotChangeTheLayout) {
    NoiseFrames source(64, 48, {"Mono8"}, kFrames);
    const GigeServing server(source, {.faults = {.freeze_at = 0}});
    ASSERT_EQ(server.failure(), "");
    ForgedStream stream(server.address());
    stream.send({.width = 3000, .height = 2000}, 1, 1);
    const Arrival arrival = stream.wait();
    const auto* frame = std::get_if<CapturedFrame>(&arrival);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->record.status, FrameStatus::kOtherLayout);
    EXPECT_EQ(frame->record.layout.width, 64);
    EXPECT_EQ(frame->payload.size(), 64U * 48U);
    EXPECT_EQ(stream.width(), 64);
}

TEST_F(AravisResendTest, WhatIsNoImageIsNeverACompleteFrame) {
    NoiseFrames source(64, 48, {"Mono8"}, kFrames);
    const GigeServing server(source, {.faults = {.freeze_at = 0}});
    ASSERT_EQ(server.failure(), "");
    ForgedStream stream(server.address());
    int complete = 0;
    int other = 0;
    for (std::uint16_t id = 1; id <= 12; ++id) {  // more than there are buffers
        stream.send({.width = 64, .height = 48}, id % 2 == 1 ? 1 : 2, id);
        for (Arrival arrival = stream.wait(300ms); std::holds_alternative<CapturedFrame>(arrival);
             arrival = stream.wait(300ms)) {
            const auto& frame = std::get<CapturedFrame>(arrival);
            other += frame.record.status == FrameStatus::kOtherLayout ? 1 : 0;
            if (frame.record.status != FrameStatus::kComplete) continue;
            ++complete;
            EXPECT_EQ(frame.record.wire_id % 2, 1U);
            EXPECT_EQ(frame.payload, std::vector<std::uint8_t>(64 * 48, 7));
        }
    }
    EXPECT_EQ(complete, 6);
    EXPECT_EQ(other, 6);
}

TEST_F(AravisResendTest, PacketsFromElsewhereAreNotSeen) {
    NoiseFrames source(64, 48, {"Mono8"}, kFrames);
    const GigeServing server(source, {.faults = {.freeze_at = 0}});
    ASSERT_EQ(server.failure(), "");
    ForgedStream stream(server.address());
    stream.send({.width = 64, .height = 48}, 1, 1, {0x7F000001, 40000});
    EXPECT_TRUE(std::holds_alternative<NoFrame>(stream.wait(200ms)));
}

/// Traffic of another camera: leaders of block 60, until it is gone.
class OtherCamera {
  public:
    ~OtherCamera() { stop(); }
    void stop() {
        thread_.request_stop();
        if (thread_.joinable()) thread_.join();
    }

  private:
    UdpSocket host_{{kHost, 0}};
    UdpSocket camera_{{kHost, 0}};
    std::jthread thread_{[this](const std::stop_token& stop) {
        GvspBlock block;
        block.id = 60;
        const GvspPacket leader = gvsp_packet(block, 0);
        while (!stop.stop_requested()) {
            camera_.send(host_.local(), std::span(leader.head).first(leader.head_bytes));
            while (host_.receive()) {
            }
        }
    }};
    static constexpr std::uint32_t kHost = 0x7F010203;
};

TEST_F(AravisResendTest, TheStreamOfAnotherCameraHidesNoFrame) {
    NoiseFrames source(64, 48, {"Mono8"}, kFrames);
    const GigeServing server(source);
    ASSERT_EQ(server.failure(), "");
    for (int i = 0; i < 5; ++i) {  // the gap in Aravis is short
        OtherCamera other;
        const auto camera =
            open_camera("gige:" + ipv4_text(server.address()), {{"GevSCPSPacketSize", "1500"}}, {});
        other.stop();
        camera->start();
        const Arrival arrival = camera->wait(kLong);
        ASSERT_TRUE(std::holds_alternative<CapturedFrame>(arrival));
        EXPECT_EQ(std::get<CapturedFrame>(arrival).record.wire_id, 1U);
    }
}

}  // namespace
}  // namespace stipple
