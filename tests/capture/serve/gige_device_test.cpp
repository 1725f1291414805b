#include "capture/serve/gige_device.h"

#include <gtest/gtest.h>

#include <bit>

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr UdpEndpoint kFirst{0x7F000001, 5000};
constexpr UdpEndpoint kSecond{0x7F000001, 5001};

ServedImage image_of(std::string coded = {}) {
    ServedImage image;
    image.width = 64;
    image.height = 48;
    image.formats = {pixel_format_named("Mono8"), pixel_format_named("Mono16")};
    image.frames_hz = 200;
    image.frames = 100;
    image.coded_header = std::move(coded);
    image.croppable = image.coded_header.empty();
    return image;
}

/// A device, and commands to it at a time that the test sets.
class GigeDeviceTest : public ::testing::Test {
  protected:
    std::uint16_t write(std::uint32_t address, std::uint32_t value, UdpEndpoint peer = kFirst) {
        GvcpCommand command{0x82, 1, true, GvcpWriteRegisters{{{address, value}}}};
        return status_of(execute(command, peer));
    }
    std::uint16_t read_status(std::uint32_t address, UdpEndpoint peer = kFirst) {
        GvcpCommand command{0x80, 1, true, GvcpReadRegisters{{address}}};
        return status_of(execute(command, peer));
    }
    GigeOutcome execute(const GvcpCommand& command, UdpEndpoint peer) {
        return device_.execute(command, peer, now_);
    }
    static std::uint16_t status_of(const GigeOutcome& outcome) {
        return load_be<std::uint16_t>(outcome.reply.data());
    }
    void take_control() { ASSERT_EQ(write(gige::kControl, 2), 0); }

    GigeDevice device_{{}, image_of()};
    GigeDevice::Time now_{seconds(10)};
};

TEST_F(GigeDeviceTest, WhoIsNotInControlCannotWrite) {
    EXPECT_EQ(write(gige::kWidth, 32), 0x8006);
    take_control();
    EXPECT_EQ(write(gige::kWidth, 32), 0);
    EXPECT_EQ(write(gige::kWidth, 16, kSecond), 0x8006);
    EXPECT_EQ(write(gige::kControl, 2, kSecond), 0x8006);
    EXPECT_EQ(write(gige::kControl, 0, kSecond), 0x8006);
    EXPECT_EQ(read_status(gige::kWidth, kSecond), 0);
    EXPECT_EQ(device_.word(gige::kWidth), 32U);
}

TEST_F(GigeDeviceTest, ExclusiveControlKeepsReadersOut) {
    EXPECT_EQ(write(gige::kControl, 1), 0);
    EXPECT_EQ(read_status(gige::kWidth, kSecond), 0x8006);
    EXPECT_EQ(read_status(gige::kControl, kSecond), 0);
    EXPECT_EQ(read_status(gige::kWidth), 0);
}

TEST_F(GigeDeviceTest, ReleasedControlCanBeTaken) {
    take_control();
    EXPECT_EQ(write(gige::kControl, 0), 0);
    EXPECT_EQ(write(gige::kControl, 2, kSecond), 0);
    EXPECT_EQ(device_.controller(), kSecond);
}

TEST_F(GigeDeviceTest, ASilentControllerLosesControlAndStream) {
    take_control();
    write(gige::kHeartbeatMs, 1000);
    write(gige::kStreamPort, 4000);
    write(gige::kAcquisitionStart, 1);
    now_ += milliseconds(900);
    EXPECT_EQ(read_status(gige::kControl), 0);  // a heartbeat
    now_ += milliseconds(900);
    EXPECT_FALSE(device_.check_heartbeat(now_));
    now_ += milliseconds(100);
    EXPECT_TRUE(device_.check_heartbeat(now_));
    EXPECT_FALSE(device_.controller());
    EXPECT_FALSE(device_.stream().running);
    EXPECT_EQ(device_.stream().destination.port, 0);
    EXPECT_EQ(write(gige::kControl, 2, kSecond), 0);
}

TEST_F(GigeDeviceTest, NoHeartbeatTimeoutKeepsAControllerThatHasGone) {
    take_control();
    EXPECT_EQ(write(gige::kHeartbeatMs, 0xFFFFFFFF), 0);
    EXPECT_EQ(device_.word(gige::kHeartbeatMs), 10'000U);
    now_ += seconds(10);
    EXPECT_TRUE(device_.check_heartbeat(now_));
    EXPECT_FALSE(device_.controller());
}

TEST_F(GigeDeviceTest, FramesGoToTheControllersAddressAlone) {
    constexpr UdpEndpoint kElsewhere{0x7F000042, 5000};
    take_control();
    EXPECT_EQ(write(gige::kStreamDestination, kElsewhere.address), 0x8002);
    EXPECT_EQ(write(gige::kStreamDestination, kFirst.address), 0);
    EXPECT_EQ(write(gige::kStreamDestination, 0), 0);
    EXPECT_EQ(write(gige::kStreamDestination, kFirst.address), 0);
    EXPECT_EQ(write(gige::kControl, 0), 0);
    // The next one does not send to the one before.
    EXPECT_EQ(write(gige::kControl, 2, kElsewhere), 0);
    EXPECT_EQ(write(gige::kStreamPort, 4000, kElsewhere), 0);
    EXPECT_FALSE(device_.stream().destination.is_set());
}

TEST(OpenGigeDeviceTest, FramesGoElsewhereWhereThatIsAllowed) {
    GigeIdentity identity;
    identity.allow_other_destination = true;
    GigeDevice device(identity, image_of());
    const auto outcome = device.execute(
        {0x82, 1, true,
         GvcpWriteRegisters{{{gige::kControl, 2}, {gige::kStreamDestination, 0x7F000042}}}},
        kFirst, seconds(1));
    EXPECT_EQ(load_be<std::uint16_t>(outcome.reply.data()), 0);
    EXPECT_EQ(device.stream().destination.address, 0x7F000042U);
}

TEST_F(GigeDeviceTest, OthersDoNotKeepTheHeartbeatGoing) {
    take_control();
    for (int i = 0; i < 10; ++i) {
        now_ += milliseconds(400);
        EXPECT_EQ(read_status(gige::kWidth, kSecond), 0);
    }
    EXPECT_FALSE(device_.controller());
}

TEST_F(GigeDeviceTest, WhileItStreamsTheLayoutIsLocked) {
    take_control();
    EXPECT_EQ(write(gige::kAcquisitionStart, 1), 0);
    EXPECT_EQ(device_.word(gige::kParametersLocked), 1U);
    for (const auto address : {gige::kWidth, gige::kHeight, gige::kOffsetX, gige::kPixelFormat,
                               gige::kChunkModeActive, gige::kFrameRate})
        EXPECT_EQ(write(address, 1), 0x8007) << address;
    EXPECT_EQ(write(gige::kAcquisitionStop, 1), 0);
    EXPECT_EQ(device_.word(gige::kParametersLocked), 0U);
    EXPECT_EQ(write(gige::kWidth, 32), 0);
}

TEST_F(GigeDeviceTest, PayloadSizeFollowsRegionFormatAndChunks) {
    take_control();
    EXPECT_EQ(device_.word(gige::kPayloadSize), 64U * 48);
    write(gige::kPixelFormat, 0x01100007);
    EXPECT_EQ(device_.word(gige::kPayloadSize), 64U * 48 * 2);
    write(gige::kWidth, 32);
    write(gige::kHeight, 10);
    EXPECT_EQ(device_.word(gige::kPayloadSize), 32U * 10 * 2);
    write(gige::kChunkModeActive, 1);
    // Image, slot, exposure map, time: 8 bytes each for id and length, and 8 + 4 + 8.
    EXPECT_EQ(device_.word(gige::kPayloadSize), 32U * 10 * 2 + 4 * 8 + 20);
    write(gige::kChunkEnable, 0);
    EXPECT_EQ(device_.word(gige::kPayloadSize), 32U * 10 * 2 + 3 * 8 + 12);
}

TEST_F(GigeDeviceTest, RegionsOutsideTheSensorAreRefused) {
    take_control();
    EXPECT_EQ(write(gige::kWidth, 65), 0x8002);
    EXPECT_EQ(write(gige::kHeight, 0), 0x8002);
    EXPECT_EQ(write(gige::kOffsetX, 1), 0x8002);  // the width leaves no room
    EXPECT_EQ(write(gige::kWidth, 60), 0);
    EXPECT_EQ(write(gige::kOffsetX, 4), 0);
    EXPECT_EQ(write(gige::kWidth, 61), 0x8002);
    EXPECT_EQ(write(gige::kOffsetY, 0xFFFFFFFF), 0x8002);
    EXPECT_EQ(write(gige::kPixelFormat, 0x010C0047), 0x8002);  // not served
}

TEST_F(GigeDeviceTest, ReadOnlyAndUnknownRegistersAreRefused) {
    take_control();
    EXPECT_EQ(write(gige::kSensorWidth, 1), 0x8004);
    EXPECT_EQ(write(gige::kVersion, 1), 0x8004);
    EXPECT_EQ(write(gige::kPayloadSize, 1), 0x8004);
    EXPECT_EQ(write(gige::kXmlText, 1), 0x8004);
    EXPECT_EQ(write(0x10000, 1), 0x8003);
    EXPECT_EQ(read_status(0x10000), 0x8003);
    EXPECT_EQ(read_status(0xFFFFFFFC), 0x8003);
    EXPECT_EQ(read_status(2), 0x8005);
}

TEST_F(GigeDeviceTest, FrameRatesOutsideTheLimitsAreRefused) {
    take_control();
    const auto rate = [&](float value) {
        return write(gige::kFrameRate, std::bit_cast<std::uint32_t>(value));
    };
    EXPECT_EQ(rate(200.0F), 0);
    for (const float wrong : {0.0F, -5.0F, 200.1F, 1e9F, std::bit_cast<float>(0x7FC00000U)})
        EXPECT_EQ(rate(wrong), 0x8002) << wrong;
    EXPECT_EQ(device_.stream().frames_hz, 200);
}

TEST_F(GigeDeviceTest, PacketsAreAtMost100MillisecondsApart) {
    take_control();
    EXPECT_EQ(write(gige::kStreamPacketDelay, 100'000'000), 0);
    EXPECT_EQ(write(gige::kStreamPacketDelay, 100'000'001), 0x8002);
    EXPECT_EQ(device_.stream().packet_delay, milliseconds(100));
}

TEST_F(GigeDeviceTest, TheXmlIsWhereTheUrlSays) {
    std::string url;
    for (std::uint32_t at = gige::kXmlUrl; device_.word(at) != 0; at += 4)
        for (const unsigned shift : {24U, 16U, 8U, 0U})
            if (const auto c = static_cast<char>(device_.word(at) >> shift & 0xFFU); c != 0)
                url += c;
    char length[16];
    std::snprintf(length, sizeof length, "%zX", device_.xml().size());
    EXPECT_EQ(url, "Local:stipple.xml;200000;" + std::string(length));
    const GigeOutcome outcome =
        execute({0x84, 1, true, GvcpReadMemory{gige::kXmlText, 64}}, kSecond);
    ASSERT_EQ(outcome.reply.size(), 8 + 4 + 64U);
    EXPECT_EQ(std::string(outcome.reply.begin() + 12, outcome.reply.end()),
              device_.xml().substr(0, 64));
    // The last word of it, and the one after.
    const auto end = static_cast<std::uint32_t>(gige::kXmlText + device_.xml().size() / 4 * 4);
    EXPECT_EQ(read_status(end), 0);
    EXPECT_EQ(read_status(end + 4), 0x8003);
}

TEST_F(GigeDeviceTest, OnlyTheControllersPortsCanAskForPackets) {
    constexpr UdpEndpoint kStream{kFirst.address, 4000};
    const GvcpCommand resend{0x40, 1, false, GvcpPacketResend{0, 5, 1, 2}};
    EXPECT_FALSE(execute(resend, kFirst).resend);
    take_control();
    EXPECT_TRUE(execute(resend, kFirst).resend);
    EXPECT_FALSE(execute(resend, kStream).resend);
    write(gige::kStreamDestination, kStream.address);
    write(gige::kStreamPort, kStream.port);
    EXPECT_TRUE(execute(resend, kStream).resend);
    EXPECT_FALSE(execute(resend, kSecond).resend);  // another program on the same machine
    EXPECT_FALSE(execute(resend, {0x7F000002, kStream.port}).resend);
    EXPECT_TRUE(execute(resend, kFirst).reply.empty());
}

TEST_F(GigeDeviceTest, ATestPacketIsFiredOnceAndTheBitReadsZero) {
    take_control();
    const GvcpCommand command{0x82, 1, true,
                              GvcpWriteRegisters{{{gige::kStreamPacketSize, 0xC0000000U | 9000}}}};
    EXPECT_TRUE(execute(command, kFirst).fire_test_packet);
    EXPECT_EQ(device_.word(gige::kStreamPacketSize), 0x40000000U | 9000);
    EXPECT_TRUE(device_.stream().do_not_fragment);
    EXPECT_EQ(read_status(gige::kStreamPacketSize), 0);
    EXPECT_EQ(write(gige::kStreamPacketSize, 64), 0x8002);
}

TEST(CodedGigeDeviceTest, HasAFixedRegionAndShowsTheHeader) {
    GigeDevice device({}, image_of("89535450"));
    const GigeDevice::Time now{seconds(1)};
    static_cast<void>(
        device.execute({0x82, 1, true, GvcpWriteRegisters{{{gige::kControl, 2}}}}, kFirst, now));
    const auto width =
        device.execute({0x82, 1, true, GvcpWriteRegisters{{{gige::kWidth, 32}}}}, kFirst, now);
    EXPECT_EQ(load_be<std::uint16_t>(width.reply.data()), 0x8004);
    const auto header =
        device.execute({0x84, 1, true, GvcpReadMemory{gige::kCodedHeader, 12}}, kFirst, now);
    EXPECT_EQ(std::string(header.reply.begin() + 12, header.reply.end()),
              std::string("89535450\0\0\0\0", 12));
    EXPECT_NE(device.xml().find("CodedStreamHeader"), std::string::npos);
}

}  // namespace
}  // namespace stipple
