#include "stream/header_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

StreamHeader decode(const Bytes& bytes) {
    const std::size_t length = header_bytes(
        std::span(bytes).first(std::min(bytes.size(), kHeaderStartBytes)), "a.stipple");
    EXPECT_EQ(length, bytes.size());
    return decode_header(bytes, "a.stipple");
}

void seal(Bytes& header) {
    store(&header[header.size() - 4], crc32c(std::span(header).first(header.size() - 4)));
}

/// A header with `value` at `offset` and a good CRC is refused there, with `problem`.
template <Stored T>
void expect_refused(std::size_t offset, T value, const std::string& problem) {
    Bytes bytes = encode_header(varied_header(), "a.stipple");
    store(&bytes[offset], value);
    seal(bytes);
    expect_parts(message_of<InputError>([&] { return decode(bytes); }),
                 {"a.stipple: byte " + std::to_string(offset) + ": " + problem});
}

TEST(HeaderCodecTest, DecodesWhatItEncodes) {
    StreamHeader header = varied_header({65535, 3, 4}, 16);
    header.slot_us = 0.1;
    header.calibration = {1, Rounding::kFloor, 0.5, 1e-12, 0, 1e12, 1.0 / 3};
    header.schedule_name = std::string(64, 'n');
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.schedule_name = "";
    header.provenance = "";
    EXPECT_EQ(decode(encode_header(header, "")), header);
}

TEST(HeaderCodecTest, IntegersOutsideTheirLimitsAreRefused) {
    using U8 = std::uint8_t;
    using U16 = std::uint16_t;
    expect_refused(16, U16{0}, "rows 0 is outside 1..65535");
    expect_refused(18, U16{0}, "columns 0 is outside 1..65535");
    expect_refused(20, U8{0}, "planes 0 is outside 1..4");
    expect_refused(20, U8{5}, "planes 5 is outside 1..4");
    expect_refused(21, U8{1}, "colour filter array 1 is outside 0..0");
    expect_refused(22, U8{0}, "bit depth 0 is outside 1..16");
    expect_refused(22, U8{17}, "bit depth 17 is outside 1..16");
    expect_refused(23, U8{2}, "rounding 2 is outside 0..1");
    expect_refused(84, U8{2}, "schedule kind 2 is outside 0..1");
    expect_refused(16, std::uint32_t{0xFFFFFFFF}, "rows x columns x planes 4294836225 is outside");
    for (const std::size_t reserved : {10U, 11U, 85U, 86U, 87U})
        expect_refused(reserved, U8{1}, "reserved byte is not zero");
}

TEST(HeaderCodecTest, NumbersThatAreNotPhysicalAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const std::size_t offset : {24U, 32U, 40U, 48U, 56U, 64U})
        for (const double value : {nan, infinity, -infinity, -1.0, 1.1e12})
            expect_refused(offset, value, "");
    for (const std::size_t above_zero : {24U, 40U, 56U, 64U}) expect_refused(above_zero, 0.0, "");
    expect_refused(24, -5.0, "slot duration in us -5 is outside 1e-12..1e+12");
}

TEST(HeaderCodecTest, LengthsMustAddUp) {
    expect_refused(72, std::uint32_t{65}, "bytes of the schedule name 65 is outside 0..64");
    expect_refused(76, (1U << 20U) + 1, "bytes of the provenance text 1048577 is outside");
    expect_refused(76, 100000U, "bytes of the provenance text 100000 exceeds the header");
    expect_refused(80, 0U, "bytes of the schedule section 0 is outside 1..");
    expect_refused(80, 0x20000000U, "bytes of the schedule section 536870912 is outside");
    Bytes bytes = encode_header(varied_header(), "");
    --bytes[72];
    seal(bytes);
    expect_parts(message_of<InputError>([&] { return decode(bytes); }),
                 {"a.stipple: byte 12: header bytes are not the sum of its parts"});
}

TEST(HeaderCodecTest, TextsThatWouldSteerATerminalAreRefused) {
    for (const char* bad : {"\x1B[2J", "a\nb", "\xC2\x9B", "\xFF", "\xC0\xAF", "\xED\xA0\x80",
                            "\xF4\x90\x80\x80", "\xC3"}) {
        StreamHeader header = varied_header();
        header.schedule_name = bad;
        expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                     {"a: byte 92: schedule name is not UTF-8 without control characters"});
    }
    StreamHeader header = varied_header();
    header.provenance = "\x7F";
    expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                 {"provenance text is not UTF-8"});
    header.provenance = "tab\t and lines\r\n \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80";
    EXPECT_EQ(decode(encode_header(header, "")), header);
}

TEST(HeaderCodecTest, AForeignFileIsCalledForeign) {
    const auto refusal = [](const std::string& start) {
        return message_of<InputError>([&] {
            return header_bytes({reinterpret_cast<const std::uint8_t*>(start.data()), start.size()},
                                "a");
        });
    };
    EXPECT_EQ(refusal(""), "a: byte 0: the file is empty");
    EXPECT_EQ(refusal("\x93NUMPY"), "a: byte 0: this is not a sample stream (.stipple)");
    for (std::size_t length = 1; length < 16; ++length)
        expect_parts(refusal(std::string(length, '#')), {"this is not a sample stream"});
    expect_parts(refusal("\x89STPL\n\x1A\x01\0\0\0\0\0\0\0\0"), {"text-mode transfer"});
    expect_parts(refusal("\tSTPL\r\n\x1A"), {"text-mode transfer"});
    expect_parts(refusal(std::string("\x89STPL\r\n\x1A\x02\0\0\0\0\0\0\0", 16)),
                 {"a: byte 8: version 2 of the sample stream; this program reads version 1"});
    expect_parts(refusal(std::string("\x89STPL\r\n\x1A\x01\0\0\0\xFF\xFF\xFF\xFF", 16)),
                 {"a: byte 12: header bytes 4294967295 is outside"});
}

TEST(HeaderCodecTest, AHeaderTakesNoMemoryThatTheFileDoesNotHave) {
    std::string bytes("\x89STPL\r\n\x1A\x01\0\0\0\0\0\0\x10 and so on", 26);
    expect_parts(message_of<InputError>([&] { return read_bytes(bytes); }),
                 {"byte 26: the file ends within its header of 268435456 bytes"});
}

}  // namespace
}  // namespace stipple
