#include "capture/serve/coded_payload.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "tests/stream/stream_files.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<SamplePacket> slot_of(const StreamHeader& header, std::int64_t slot) {
    return {random_packet(header, slot, 0, header.shape.rows)};
}

TEST(CodedPayloadTest, EverySlotFitsAndComesBack) {
    const StreamHeader header = varied_header({40, 80, 1});
    const ServedImage image = coded_image(header);
    EXPECT_EQ(image.width, kCodedImageWidth);
    EXPECT_FALSE(image.croppable);
    for (std::int64_t slot = 0; slot < 15; ++slot) {
        const auto packets = slot_of(header, slot);
        const Bytes payload = coded_payload(packets, coded_header(header), image);
        EXPECT_EQ(payload.size(),
                  static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
        const CodedSlot decoded = decode_coded_payload(coded_header(header), payload, {slot, 0});
        EXPECT_EQ(decoded.fault, "");
        EXPECT_EQ(decoded.packets, packets);
    }
}

TEST(CodedPayloadTest, AHeaderThatIsTooLongForRegistersIsRefusedWithWhatToDo) {
    StreamHeader header = random_header({512, 512, 1}, 1);
    header.schedule_source = {};  // written out, not as a seed
    try {
        static_cast<void>(coded_image(header));
        FAIL() << "served";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("choose a schedule with a smaller tile"),
                  std::string::npos)
            << e.what();
    }
}

// The packets of a file of three slots, one after the other.
TEST(CodedPayloadTest, TheBytesAreThoseOfTheFile) {
    const TemporaryFolder folder;
    const StreamHeader header = varied_header();
    const ServedImage image = coded_image(header);
    const auto file = folder.path() / "clip.stipple";
    StreamWriter writer(file, header);
    Bytes expected;
    for (std::int64_t slot = 0; slot < 3; ++slot) {
        const auto begin = writer.bytes_written();
        writer.write(slot_of(header, slot)[0]);
        std::ifstream stream(file, std::ios::binary);
        const Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
        Bytes packet(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end());
        Bytes payload = coded_payload(slot_of(header, slot), coded_header(header), image);
        EXPECT_EQ(
            Bytes(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(packet.size())),
            packet);
        for (std::size_t i = packet.size(); i < payload.size(); ++i) ASSERT_EQ(payload[i], 0);
    }
}

TEST(CodedPayloadTest, ADroppedBandComesBack) {
    const StreamHeader header = varied_header();
    const ServedImage image = coded_image(header);
    const std::vector<SamplePacket> packets{random_packet(header, 7, 0, 3),
                                            {7, 3, 1, SamplePacket::kDropped, {}}};
    const CodedSlot decoded = decode_coded_payload(
        coded_header(header), coded_payload(packets, coded_header(header), image), {5, 0});
    EXPECT_EQ(decoded.fault, "");
    EXPECT_EQ(decoded.packets, packets);
}

TEST(CodedPayloadTest, DamageIsFoundWhereverItIs) {
    const StreamHeader header = varied_header();
    const ServedImage image = coded_image(header);
    const auto packets = slot_of(header, 6);
    const Bytes good = coded_payload(packets, coded_header(header), image);
    const std::size_t used = 36 + (packets[0].dn.size() * 10 + 7) / 8;
    for (std::size_t at = 0; at < used; ++at) {
        Bytes bad = good;
        bad[at] ^= 0x10U;
        const CodedSlot decoded = decode_coded_payload(coded_header(header), bad, {6, 0});
        EXPECT_NE(decoded.fault, "") << at;
        EXPECT_TRUE(decoded.packets.empty()) << at;
    }
    EXPECT_NE(decode_coded_payload(coded_header(header), Bytes(1024), {6, 0}).fault, "");
    EXPECT_NE(decode_coded_payload(coded_header(header), {}, {6, 0}).fault, "");
    EXPECT_NE(
        decode_coded_payload(coded_header(header), std::span(good).first(used - 1), {6, 0}).fault,
        "");
}

TEST(CodedPayloadTest, ASlotThatComesTwiceIsRefused) {
    const StreamHeader header = varied_header();
    const Bytes payload =
        coded_payload(slot_of(header, 6), coded_header(header), coded_image(header));
    EXPECT_NE(decode_coded_payload(coded_header(header), payload, {7, 0}).fault, "");
}

TEST(CodedPayloadTest, PacketsOfAnotherStreamAreDamage) {
    StreamHeader header = varied_header();
    const Bytes payload =
        coded_payload(slot_of(header, 6), coded_header(header), coded_image(header));
    header.provenance += "other = 1\n";
    EXPECT_EQ(decode_coded_payload(coded_header(header), payload, {6, 0}).fault,
              "no packet begins here");
}

// Such a server knows version 1 of the sample stream only.
TEST(CodedPayloadTest, AServerOfVersion1IsUnderstood) {
    const StreamHeader header = varied_header();
    const CodedHeader version_1{header, {1, 0}};
    const Bytes payload = coded_payload(slot_of(header, 6), version_1, coded_image(header));
    EXPECT_EQ(decode_coded_payload(version_1, payload, {6, 0}).packets, slot_of(header, 6));
    EXPECT_NE(decode_coded_payload(coded_header(header), payload, {6, 0}).fault, "");
}

TEST(CodedPayloadTest, TheHeaderComesBackFromItsDigits) {
    const StreamHeader header = varied_header();
    const std::string digits = coded_image(header).coded_header;
    const CodedHeader decoded = decode_coded_header(digits, "here");
    EXPECT_EQ(decoded.stream, header);
    EXPECT_EQ(decoded.framing.seed, coded_header(header).framing.seed);
    EXPECT_EQ(decoded.framing.version, 2);
    for (const std::string& wrong :
         {std::string(), std::string("89"), digits.substr(2), digits.substr(0, digits.size() - 2),
          "zz" + digits.substr(2), digits + "00"})
        EXPECT_THROW(static_cast<void>(decode_coded_header(wrong, "here")), InputError)
            << wrong.size();
}

}  // namespace
}  // namespace stipple
