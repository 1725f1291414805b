#include "capture/serve/gige_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>

#include "capture/serve/gige_registers.h"
#include "capture/serve/gvsp_codec.h"
#include "tests/capture/serve/gige_client.h"
#include "tests/capture/serve/gige_serving.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A block put together from packets.
struct Block {
    std::map<std::uint32_t, Bytes> packets;  ///< without the header
    std::uint32_t last = 0;                  ///< id of the trailer, once it is there

    [[nodiscard]] bool is_whole() const { return last > 0 && packets.size() == last + 1; }
    [[nodiscard]] Bytes payload() const {
        Bytes bytes;
        for (const auto& [id, data] : packets)
            if (id > 0 && id < last) bytes.insert(bytes.end(), data.begin(), data.end());
        return bytes;
    }
};

/// Streams from a server until `frames` blocks are whole or nothing comes any more.
class GigeServerTest : public ::testing::Test {
  protected:
    void open(const GigeServerOptions& options = {}) { open(source_, options); }
    void open(FrameSource& source, const GigeServerOptions& options = {}) {
        serving_ = std::make_unique<GigeServing>(source, options);
        if (!serving_->failure().empty()) GTEST_SKIP() << serving_->failure();
        client_ = std::make_unique<GigeClient>(serving_->address());
        take_control();
    }
    void take_control() {
        ASSERT_EQ(client_->write(gige::kControl, 2), 0);
        ASSERT_EQ(client_->write(gige::kStreamDestination, 0x7F000001), 0);
        ASSERT_EQ(client_->write(gige::kStreamPort, client_->data_port()), 0);
    }
    void start() { ASSERT_EQ(client_->write(gige::kAcquisitionStart, 1), 0); }

    void take(const Datagram& packet) {
        const auto& bytes = packet.bytes;
        ASSERT_GE(bytes.size(), 8U);
        order_.push_back(load_be<std::uint16_t>(&bytes[2]));
        Block& block = blocks_[order_.back()];
        const std::uint32_t id = load_be<std::uint32_t>(&bytes[4]) & 0xFFFFFFU;
        if (bytes[4] == 2) block.last = id;
        block.packets[id] = {bytes.begin() + 8, bytes.end()};
        ++received_;
    }
    /// False if nothing comes for a second before `done`.
    bool receive_until(const std::function<bool()>& done) {
        while (!done()) {
            const auto packet = client_->packet(1000);
            if (!packet) return false;
            take(*packet);
        }
        return true;
    }
    std::size_t whole() const {
        std::size_t count = 0;
        for (const auto& [id, block] : blocks_) count += block.is_whole() ? 1U : 0U;
        return count;
    }

    NoiseFrames source_{64, 48, {"Mono8", "Mono16"}, 20};
    std::unique_ptr<GigeServing> serving_;
    std::unique_ptr<GigeClient> client_;
    std::map<std::uint16_t, Block> blocks_;
    std::vector<std::uint16_t> order_;
    std::size_t received_ = 0;
};

TEST_F(GigeServerTest, AnswersADiscoveryWithItsAddressAndNames) {
    GigeServerOptions options;
    options.model = "Chip";
    options.serial = "ab12";
    open(options);
    const auto answer = client_->ask(GvcpCode::kDiscovery, {});
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->content.size(), 0xF8U);
    EXPECT_EQ(load_be<std::uint32_t>(&answer->content[0x24]), serving_->address());
    EXPECT_STREQ(reinterpret_cast<const char*>(&answer->content[0x48]), "Stipple");
    EXPECT_STREQ(reinterpret_cast<const char*>(&answer->content[0x68]), "Chip");
    EXPECT_STREQ(reinterpret_cast<const char*>(&answer->content[0xD8]), "ab12");
}

TEST_F(GigeServerTest, FramesArriveBitExact) {
    open();
    ASSERT_EQ(client_->write(gige::kPixelFormat, 0x01100007), 0);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 20; }));
    for (std::uint16_t i = 0; i < 20; ++i)
        EXPECT_EQ(blocks_[static_cast<std::uint16_t>(i + 1)].payload(),
                  source_.bytes(i, *pixel_format_named("Mono16")))
            << i;
}

TEST_F(GigeServerTest, ARegionIsCutOut) {
    open();
    ASSERT_EQ(client_->write(gige::kWidth, 20), 0);
    ASSERT_EQ(client_->write(gige::kHeight, 10), 0);
    ASSERT_EQ(client_->write(gige::kOffsetX, 7), 0);
    ASSERT_EQ(client_->write(gige::kOffsetY, 5), 0);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 20; }));
    const Bytes full = source_.bytes(3, *pixel_format_named("Mono8"));
    Bytes region;
    for (std::size_t row = 5; row < 15; ++row)
        for (std::size_t col = 7; col < 27; ++col) region.push_back(full[row * 64 + col]);
    EXPECT_EQ(blocks_[4].payload(), region);
}

TEST_F(GigeServerTest, PacketsAreSentTheDelayApart) {
    open();
    constexpr std::uint32_t kDelayNs = 2'000'000;  // a tick of the camera's clock is 1 ns
    ASSERT_EQ(client_->write(gige::kStreamPacketDelay, kDelayNs), 0);
    ASSERT_EQ(client_->write(gige::kStreamPacketSize, 128 + 36), 0);
    const auto begin = std::chrono::steady_clock::now();
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 1; }));
    // 64 x 48 / 128 packets, leader and trailer: each waits.
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::nanoseconds(26 * kDelayNs));
    EXPECT_EQ(blocks_[1].payload(), source_.bytes(0, *pixel_format_named("Mono8")));
}

/// A frame takes 205 s: 2050 packets, 100 ms apart.
class SlowGigeServerTest : public GigeServerTest {
  protected:
    void SetUp() override {
        open(large_);
        if (IsSkipped()) return;
        ASSERT_EQ(client_->write(gige::kStreamPacketSize, 128 + 36), 0);
        ASSERT_EQ(client_->write(gige::kStreamPacketDelay, 100'000'000), 0);
        start();
        ASSERT_TRUE(client_->packet());
    }
    void TearDown() override { serving_.reset(); }  // before its source

    /// Another stream, without delay, begins at once.
    void expect_fast_stream() {
        ASSERT_EQ(client_->write(gige::kStreamPacketDelay, 0), 0);
        ASSERT_EQ(client_->write(gige::kStreamPacketSize, 8000), 0);
        ASSERT_EQ(client_->write(gige::kHeight, 64), 0);  // so that a socket holds both frames
        start();
        while (!blocks_[2].is_whole()) {
            const auto packet = client_->packet();
            ASSERT_TRUE(packet);
            take(*packet);
        }
        Bytes top = large_.bytes(1, *pixel_format_named("Mono8"));
        top.resize(512 * 64);
        EXPECT_EQ(blocks_[2].payload(), top);
        while (client_->read(gige::kParametersLocked) == 1U) std::this_thread::yield();
        EXPECT_EQ(serving_->server().counts().frames, 2U);  // not the slow one
    }

    NoiseFrames large_{512, 512, {"Mono8"}, 2};
};

TEST_F(SlowGigeServerTest, AStopEndsAFrameInTheMiddle) {
    ASSERT_EQ(client_->write(gige::kAcquisitionStop, 1), 0);
    expect_fast_stream();
}

TEST_F(SlowGigeServerTest, ReleasedControlEndsAFrameInTheMiddle) {
    ASSERT_EQ(client_->write(gige::kControl, 0), 0);
    take_control();
    expect_fast_stream();
}

TEST_F(SlowGigeServerTest, TheEndOfTheServerEndsAFrameInTheMiddle) {
    serving_->stop();
    EXPECT_EQ(serving_->server().counts().frames, 0U);
}

TEST_F(SlowGigeServerTest, ARequestBringsABoundedNumberOfPackets) {
    client_->tell(GvcpCode::kPacketResend, GigeClient::words({1, 0, 0xFFFFFF}));
    EXPECT_EQ(client_->read(gige::kWidth), 512U);  // commands are carried out one by one
    EXPECT_EQ(serving_->server().counts().packets_resent, 512U);
}

TEST_F(SlowGigeServerTest, AnotherProgramGetsNoPackets) {
    GigeClient other(serving_->address());
    other.tell(GvcpCode::kPacketResend, GigeClient::words({1, 0, 9}));
    EXPECT_EQ(other.read(gige::kWidth), 512U);
    EXPECT_EQ(serving_->server().counts().packets_resent, 0U);
}

TEST_F(GigeServerTest, AFrozenCameraStillAnswersButSendsNothing) {
    GigeServerOptions options;
    options.faults.freeze_at = 5;
    open(options);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 5; }));
    EXPECT_FALSE(receive_until([] { return false; }));
    EXPECT_EQ(whole(), 5U);
    EXPECT_EQ(blocks_.size(), 5U);
    EXPECT_EQ(client_->read(gige::kWidth), 64U);
}

TEST_F(GigeServerTest, ACameraThatCannotResendSaysSo) {
    for (const bool can : {true, false}) {
        GigeServerOptions options;
        options.can_resend = can;
        open(options);
        const auto capabilities = client_->read(gige::kCapability);
        ASSERT_TRUE(capabilities.has_value());
        EXPECT_EQ((*capabilities & gige::kCanResend) != 0, can);
    }
}

TEST_F(GigeServerTest, DroppedPacketsComeWhenAskedFor) {
    GigeServerOptions options;
    options.faults.drop = 0.2;
    open(options);
    ASSERT_EQ(client_->write(gige::kStreamPacketSize, 128 + 36), 0);
    start();
    static_cast<void>(receive_until([] { return false; }));
    ASSERT_LT(whole(), 20U);
    for (std::uint16_t id = 1; id <= 20; ++id)
        for (std::uint32_t packet = 0; packet < 26; ++packet) {  // 64 x 48 / 128 + 2
            if (blocks_[id].packets.count(packet) != 0) continue;
            client_->tell(GvcpCode::kPacketResend, GigeClient::words({id, packet, packet}));
            const auto resent = client_->packet();
            ASSERT_TRUE(resent);
            EXPECT_EQ(load_be<std::uint16_t>(resent->bytes.data()), 0x0100);
            take(*resent);
        }
    for (std::uint16_t i = 0; i < 20; ++i)
        EXPECT_EQ(blocks_[static_cast<std::uint16_t>(i + 1)].payload(),
                  source_.bytes(i, *pixel_format_named("Mono8")));
    EXPECT_GT(serving_->server().counts().packets_resent, 0U);
}

TEST_F(GigeServerTest, PacketsOfForgottenBlocksAreUnavailable) {
    open();
    client_->tell(GvcpCode::kPacketResend, GigeClient::words({9, 1, 3}));
    const auto answer = client_->packet();
    ASSERT_TRUE(answer);
    EXPECT_EQ(load_be<std::uint16_t>(answer->bytes.data()), 0x800C);
    EXPECT_EQ(load_be<std::uint16_t>(&answer->bytes[2]), 9);
}

TEST_F(GigeServerTest, IdsBeginWrapAndLeaveOutAsTold) {
    GigeServerOptions options;
    options.faults.first_block = 65530;
    options.faults.gap_at = 10;
    options.faults.gap_frames = 2;
    open(options);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 20; }));
    std::vector<std::uint16_t> ids = order_;
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    EXPECT_EQ(ids,
              (std::vector<std::uint16_t>{65530, 65531, 65532, 65533, 65534, 65535, 1,  2,  3, 4, 7,
                                          8,     9,     10,    11,    12,    13,    14, 15, 16}));
}

TEST_F(GigeServerTest, StampsAreExactlyOnePeriodApart) {
    open();
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 20; }));
    const auto stamp = [&](std::uint16_t id) {
        return load_be<std::uint64_t>(&blocks_[id].packets[0][4]);
    };
    for (std::uint16_t id = 2; id <= 20; ++id)
        EXPECT_EQ(stamp(id) - stamp(static_cast<std::uint16_t>(id - 1)), 5'000'000U);
}

TEST_F(GigeServerTest, ChunksFollowTheImage) {
    open();
    ASSERT_EQ(client_->write(gige::kChunkModeActive, 1), 0);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 20; }));
    const Bytes payload = blocks_[8].payload();
    const Bytes image = source_.bytes(7, *pixel_format_named("Mono8"));
    ASSERT_EQ(payload.size(), image.size() + 52);
    EXPECT_TRUE(std::equal(image.begin(), image.end(), payload.begin()));
    const std::uint8_t* chunks = &payload[image.size()];
    EXPECT_EQ(load_be<std::uint32_t>(chunks), gige::kImageChunkId);
    EXPECT_EQ(load_be<std::uint32_t>(chunks + 4), image.size());
    EXPECT_EQ(load_be<std::uint64_t>(chunks + 8), 7U);  // slot
    EXPECT_EQ(load_be<std::uint32_t>(chunks + 16), 0x1001U);
    EXPECT_EQ(load_be<std::uint32_t>(chunks + 20), 8U);
    EXPECT_EQ(load_be<std::uint64_t>(&payload[payload.size() - 16]),
              load_be<std::uint64_t>(&blocks_[8].packets[0][4]));  // as in the leader
    EXPECT_EQ(blocks_[8].packets[0][2], 0x40);
}

TEST_F(GigeServerTest, MultiFrameEndsByItselfAndCanStartAgain) {
    open();
    ASSERT_EQ(client_->write(gige::kAcquisitionMode, gige::kMultiFrame), 0);
    ASSERT_EQ(client_->write(gige::kAcquisitionFrameCount, 3), 0);
    for (int round = 0; round < 2; ++round) {
        blocks_.clear();
        start();
        EXPECT_FALSE(receive_until([&] { return whole() == 4; }));
        EXPECT_EQ(whole(), 3U);
        EXPECT_EQ(client_->read(gige::kParametersLocked), 0U);
        EXPECT_EQ(blocks_[1].payload(), source_.bytes(0, *pixel_format_named("Mono8")));
    }
}

TEST_F(GigeServerTest, RepeatedFramesGoOnCounting) {
    GigeServerOptions options;
    options.repeat = true;
    open(options);
    start();
    ASSERT_TRUE(receive_until([&] { return whole() == 45; }));
    EXPECT_EQ(blocks_[41].payload(), source_.bytes(0, *pixel_format_named("Mono8")));
    EXPECT_EQ(client_->write(gige::kAcquisitionStop, 1), 0);
}

TEST_F(GigeServerTest, ATestPacketHasTheSizeAskedFor) {
    open();
    ASSERT_EQ(client_->write(gige::kStreamPacketSize, gige::kFireTestPacket | 1400), 0);
    const auto packet = client_->packet();
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->bytes.size(), 1400U - 28);
}

TEST_F(GigeServerTest, ASecondServerOnTheAddressIsRefused) {
    open();
    GigeServerOptions options;
    options.address = ipv4_text(serving_->address());
    EXPECT_THROW(GigeServer(source_, options), DeviceError);
    options.address = "not an address";
    EXPECT_THROW(GigeServer(source_, options), InputError);
}

TEST_F(GigeServerTest, AControllerThatFallsSilentIsReplaced) {
    open();
    ASSERT_EQ(client_->write(gige::kHeartbeatMs, 500), 0);
    GigeClient second(serving_->address());
    EXPECT_EQ(second.write(gige::kControl, 2), 0x8006);
    std::optional<std::uint16_t> status = 0x8006;
    for (int i = 0; i < 200 && status == 0x8006; ++i) {
        status = second.write(gige::kControl, 2);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(status, 0);
    EXPECT_EQ(client_->write(gige::kWidth, 32), 0x8006);
}

}  // namespace
}  // namespace stipple
